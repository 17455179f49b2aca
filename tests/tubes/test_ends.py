"""What segments begin and end at."""

from __future__ import annotations

import numpy as np

from app.tubes.ends import Ends, ends_of
from tests.tubes.routings import random_routing, routing_of, segments


def ends_and_owners(routing: object) -> Ends:
    from app.hyperedges.routing import Routing

    assert isinstance(routing, Routing)
    counts = np.diff(routing.segment_starts)
    return ends_of(routing, np.repeat(np.arange(len(counts)), counts))


def test_the_three_segments_of_a_join_have_one_place_and_one_axis() -> None:
    routing = random_routing(seed=1, hyperedges=4, attachments=5)
    ends = ends_and_owners(routing)
    for k in range(4):
        own = slice(*routing.segment_starts[k : k + 2])
        for number in range(3):
            here = routing.segment_ends[own] == 5 + number
            join = routing.join_starts[k] + number
            assert here.sum() == 3
            np.testing.assert_array_equal(
                ends.positions[own][here], np.tile(routing.join_positions[join], (3, 1))
            )
            axes = ends.axes[own][here]
            np.testing.assert_array_equal(axes, np.tile(axes[0], (3, 1)))
            np.testing.assert_allclose(axes[0], routing.join_tangents[join], atol=1e-15)


def test_only_a_last_segment_between_two_joins_ends_against_the_axis() -> None:
    generator = np.random.default_rng(2)
    three, four = (routing_of([generator.uniform(0, 5, (n, 3))]) for n in (3, 4))
    assert (ends_and_owners(three).senses == 1.0).all()
    senses = ends_and_owners(four).senses
    assert senses[-1].tolist() == [1.0, -1.0]
    assert (senses[:-1] == 1.0).all()


def test_attachments_are_free_and_joins_are_not() -> None:
    ends = ends_and_owners(random_routing(seed=3, hyperedges=1, attachments=4))
    assert ends.free.tolist() == [[True, False]] * 4 + [[False, False]]


def test_a_tangent_without_direction_gives_way_to_the_next_control_point() -> None:
    curves = (
        [[0, 0, 0], [0, 0, 0], [0, 2, 0], [3, 2, 0]],
        [[1, 1, 1], [1, 1, 1], [1, 1, 1], [1, 1, 4]],
        [[5, 5, 5]] * 4,
        [[1e6, 0, 0], [1e6 + 1e-9, 0, 0], [1e6, 5, 0], [1e6, 5, 5]],
    )
    starts = ends_and_owners(segments(*curves)).tangents[:, 0]
    np.testing.assert_array_equal(starts, [[0, 1, 0], [0, 0, 1], [0, 0, 1], [0, 1, 0]])
