"""Lengths, turning and upright shares of curves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.readability.shape import shapes_of, turning
from tests.hyperedges.scenes import placement

HANDLE = 0.5522847498
"""Of a cubic that is nearly a quarter of a circle of radius 1."""

QUARTER = [[1.0, 0.0, 0.0], [1.0, 0.0, HANDLE], [HANDLE, 0.0, 1.0], [0.0, 0.0, 1.0]]


def straight(begin: list[float], end: list[float]) -> Floats:
    return np.linspace(begin, end, 4)


def routing(cubics: list[Floats], starts: list[int], radius: float = 0.1) -> Routing:
    """Cubics of hyperedges, without their joins: shapes do not ask for these."""
    hyperedges = len(starts) - 1
    return Routing(
        control_points=np.array(cubics).reshape(-1, 4, 3),
        segment_starts=np.array(starts),
        segment_ends=np.zeros((len(cubics), 2), dtype=np.int64),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(hyperedges + 1, dtype=np.int64),
        join_planes=np.zeros(hyperedges),
        radii=np.full(hyperedges, radius),
    )


def test_an_arch_of_two_pipes_and_a_half_circle() -> None:
    quarter = np.add(QUARTER, [0.0, 0.0, 1.0])
    cubics = [
        straight([1, 0, 0], [1, 0, 1]),
        quarter,
        quarter[::-1] * [-1, 1, 1],
        straight([-1, 0, 1], [-1, 0, 0]),
        straight([0, 3, 0], [4, 3, 0]),  # of another hyperedge
    ]
    scene = placement(np.array([[1.0, 0, 0], [-1, 0, 0], [0, 3, 0], [4, 3, 0]]), [0, 2, 4])
    found = shapes_of(routing(cubics, [0, 4, 5]), scene)
    assert np.allclose(found.lengths, [2.0 + np.pi, 4.0], rtol=3e-4)
    assert np.allclose(found.shortest, [2.0, 4.0])
    assert np.allclose(found.turning, [np.pi, 0.0], rtol=1e-3)
    assert np.allclose(found.upright, [2.0, 0.0])
    assert found.stretch == pytest.approx((6.0 + np.pi) / 6.0, rel=3e-4)
    assert found.mean_turning == pytest.approx(np.pi / 2, rel=1e-3)
    assert found.upright_share == pytest.approx(2.0 / (6.0 + np.pi), rel=3e-4)


@pytest.mark.parametrize(("degrees", "share"), [(0.0, 1.0), (4.9, 1.0), (5.1, 0.0), (90.0, 0.0)])
def test_how_far_from_vertical_a_pipe_may_be(degrees: float, share: float) -> None:
    angle = np.radians(degrees)
    end = [float(np.sin(angle)), 0.0, float(-np.cos(angle))]
    scene = placement(np.array([[0.0, 0, 0], end]), [0, 2])
    found = shapes_of(routing([straight([0, 0, 0], end)], [0, 1]), scene)
    assert found.upright_share == pytest.approx(share)


def test_shortest_trees_of_a_square_and_a_triangle() -> None:
    square = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    triangle = [[0.0, 0, 2], [1, 0, 2], [0.5, np.sqrt(0.75), 2]]
    scene = placement(np.array(square + triangle), [0, 4, 7])
    nothing = [straight([0, 0, 0], [1, 0, 0])] * 2
    found = shapes_of(routing(nothing, [0, 1, 2]), scene)
    assert np.allclose(found.shortest, [1.0 + np.sqrt(3.0), np.sqrt(3.0)], rtol=1e-6)


def test_of_nothing() -> None:
    found = shapes_of(routing([], [0]), placement(np.zeros((0, 3)), [0]))
    assert (found.stretch, found.mean_turning, found.upright_share) == (1.0, 0.0, 0.0)


numbers = st.lists(st.floats(-5.0, 5.0, allow_subnormal=False), min_size=12, max_size=12)


@given(numbers, st.floats(0.01, 100.0), st.floats(-3.0, 3.0))
@settings(deadline=None)
def test_turning_does_not_depend_on_size_place_and_way_round(
    coordinates: list[float], scale: float, shift: float
) -> None:
    cubic = np.array(coordinates).reshape(1, 4, 3)
    if np.linalg.norm(np.diff(cubic, axis=1), axis=2).min() < 0.1:
        cubic = cubic + np.arange(4)[None, :, None]
    found = turning(cubic)
    assert np.allclose(turning(scale * cubic + shift), found, atol=1e-6)
    assert np.allclose(turning(cubic[:, ::-1].copy()), found, atol=1e-6)
    # A cubic's velocity is a curve of degree two: it turns by no more than two half turns.
    assert found[0] <= 2 * np.pi + 1e-9


def test_a_curve_that_stands_still_goes_on_as_before() -> None:
    # Both of the first points and both of the last ones are one, and then all of them.
    lines = np.array([[[0.0, 0, 0], [0, 0, 0], [1, 1, 0], [1, 1, 0]], [[2.0, 2, 2]] * 4])
    assert turning(lines).tolist() == [0.0, 0.0]
