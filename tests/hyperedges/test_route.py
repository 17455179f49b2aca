from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from app.hyperedges.pinches import find_pinches
from app.hyperedges.route import route
from tests.hyperedges.scenes import placement

SCENE = placement(np.random.default_rng(0).uniform(0, 9, (14, 3)) * [1, 1, 0.1], [0, 3, 5, 10, 14])


def test_a_routing_says_where_each_hyperedge_is() -> None:
    routing = route(SCENE, curves="prose")
    assert routing.segment_starts.tolist() == [0, 3, 4, 11, 16]
    assert routing.join_starts.tolist() == [0, 1, 1, 4, 6]
    assert routing.control_points.shape == (16, 4, 3)
    assert routing.segment_ends.shape == (16, 2)
    assert routing.join_positions.shape == routing.join_tangents.shape == (6, 3)
    np.testing.assert_array_equal(routing.radii, SCENE.radii)
    heights = np.repeat(routing.join_planes, np.diff(routing.join_starts))
    np.testing.assert_array_equal(routing.join_positions[:, 2], heights)


@pytest.mark.parametrize("curves", ["steiner", "prose", "symbolic"])
def test_segments_begin_and_end_where_they_say(
    curves: Literal["steiner", "prose", "symbolic"],
) -> None:
    routing = route(SCENE, curves=curves)
    for k in range(4):
        ends = slice(SCENE.attachment_starts[k], SCENE.attachment_starts[k + 1])
        joins = slice(routing.join_starts[k], routing.join_starts[k + 1])
        segments = slice(routing.segment_starts[k], routing.segment_starts[k + 1])
        places = np.vstack([SCENE.attachment_positions[ends], routing.join_positions[joins]])
        np.testing.assert_array_equal(
            routing.control_points[segments][:, [0, 3]], places[routing.segment_ends[segments]]
        )


def test_wishes_for_join_heights_are_met() -> None:
    routing = route(SCENE, join_heights=np.array([7.0, np.nan, 2.5, np.nan]))
    assert routing.join_planes[[0, 2]].tolist() == [7.0, 2.5]
    assert np.isfinite(routing.join_planes).all()


def test_options_reach_the_curves() -> None:
    plain = route(SCENE, curves="prose")
    for other in (
        route(SCENE),
        route(SCENE, curves="symbolic"),
        route(SCENE, curves="prose", fidelity="paper"),
        route(SCENE, curves="prose", clearance=2.0),
    ):
        assert not np.array_equal(plain.control_points, other.control_points)
    assert not np.array_equal(route(SCENE).join_planes, route(SCENE, clearance=2.0).join_planes)
    tilted = placement(np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 9], [7, 0, 0]]), [0, 4])
    in_space = route(tilted, curves="prose")
    in_plane = route(tilted, curves="prose", closest="plane")
    assert in_space.segment_ends.tolist() != in_plane.segment_ends.tolist()


def test_without_a_clearance_every_hyperedge_is_laid_for_itself() -> None:
    together = route(SCENE, clearance=None)
    assert (together.segment_starts[1:] > together.segment_starts[:-1]).all()
    assert find_pinches(together).segments.size == 0
    np.testing.assert_array_equal(together.attachment_counts, np.diff(SCENE.attachment_starts))


def test_the_same_placement_gives_the_same_bytes() -> None:
    assert route(SCENE).control_points.tobytes() == route(SCENE).control_points.tobytes()


def test_a_program_without_hyperedges_has_no_curves() -> None:
    routing = route(placement(np.zeros((0, 3)), [0]))
    assert len(routing.control_points) == len(routing.join_planes) == 0
    assert routing.segment_starts.tolist() == routing.join_starts.tolist() == [0]


def test_one_attachment_is_refused() -> None:
    with pytest.raises(ValueError, match="two or more"):
        route(placement(np.zeros((1, 3)), [0, 1]))
