"""How far tubes reach, found from their curves, is how far they do reach."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.hyperedges.routing import Routing
from app.scene.curve_reach import CurveReach, curve_boxes
from app.tubes.sweep import sweep

coordinates = st.floats(-100, 100).map(lambda x: round(x, 3))
curves = arrays(np.float64, (3, 4, 3), elements=coordinates)
directions = arrays(np.float64, 3, elements=st.floats(-1, 1)).filter(
    lambda way: float(np.abs(way).max()) > 1e-3
)


def alone(control_points: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> Routing:
    """Each curve a hyperedge of two attachments, of radius 0.1, 0.2 and so on."""
    count = len(control_points)
    return Routing(
        control_points=control_points,
        segment_starts=np.arange(count + 1),
        segment_ends=np.tile([0, 1], (count, 1)),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(count + 1, dtype=np.int64),
        join_planes=np.zeros(count),
        radii=0.1 * np.arange(1.0, count + 1),
    )


@given(curves, directions)
def test_no_sample_reaches_farther_and_one_reaches_as_far(
    control_points: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
    way: np.ndarray[tuple[int], np.dtype[np.float64]],
) -> None:
    routing = alone(control_points)
    t = np.linspace(0, 1, 2001)[:, None]
    weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    length = np.linalg.norm(way)
    sampled = (weights @ control_points @ way + routing.radii[:, None] * length).max()
    reached = CurveReach.of(routing).farthest(way) @ way
    assert sampled - 1e-9 <= reached <= sampled + 1e-3 * length


@given(curves)
def test_boxes_hold_all_vertices(
    control_points: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> None:
    routing = alone(control_points)
    tubes = sweep(routing, 0.01)
    for number, box in enumerate(curve_boxes(routing)):
        low, high = tubes.mesh(number).bounds
        assert (low >= box[0] - 1e-4).all()
        assert (high <= box[1] + 1e-4).all()


def test_an_arch_is_reached_at_its_top() -> None:
    arch = np.array([[[0.0, 0, 0], [0, 0, 4], [2, 0, 4], [2, 0, 0]]])
    reach = CurveReach.of(alone(arch))
    assert reach.farthest(np.array([0.0, 0, 5])) == pytest.approx([1, 0, 3.1])
    assert reach.farthest(np.array([0.0, 0, -1])) == pytest.approx([0, 0, -0.1])
    assert curve_boxes(alone(arch))[0] == pytest.approx(
        np.array([[-0.1, -0.1, -0.1], [2.1, 0.1, 3.1]])
    )
