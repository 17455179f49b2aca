from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.obstacle_gaps import near_obstacles, obstacle_gaps
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.placement.placement import Placement
from app.solids.solid import Box, Sphere
from tests.hyperedges.clearance.curves import CASES, points_at, turned
from tests.hyperedges.clearance.furniture import furnished, label

LINE = np.column_stack([np.arange(4.0), np.zeros((4, 2))])
CUBE = Box((1.0, 1.0, 1.0), 0.05)


def beyond(points: Floats, boxes: Obstacles, k: int) -> Floats:
    """Distances of points (n, 3) from one rounded box."""
    local = np.abs((points - boxes.centers[k]) @ boxes.rotations[k])
    outside: Floats = np.linalg.norm(np.maximum(local - boxes.halves[k], 0), axis=1)
    return outside - float(boxes.roundings[k])


def sampled(curve: Floats, boxes: Obstacles, k: int) -> float:
    low, high = 0.0, 1.0
    for _ in range(4):
        t = np.linspace(low, high, 60)
        found = beyond(points_at(curve, t), boxes, k)
        middle, step = t[int(found.argmin())], (high - low) / 59
        low, high = max(middle - 2 * step, 0.0), min(middle + 2 * step, 1.0)
    return float(found.min())


@given(
    seed=st.integers(0, 2**32 - 1),
    scale=st.sampled_from([1.0, 1e-6, 1e4]),
    shift=st.sampled_from([0.0, 1e5]),
    size=st.sampled_from([0.0, 0.1, 1.0, 10.0]),
    flat=st.booleans(),
    coarse=st.booleans(),
)
@settings(max_examples=CASES // 4)
def test_the_lower_bound_never_exceeds_what_sampling_finds(
    seed: int, scale: float, shift: float, size: float, flat: bool, coarse: bool
) -> None:
    chance = np.random.default_rng(seed)
    curve, half = chance.uniform(-5, 5, (4, 3)), size * chance.random(3) * [1, 1, not flat]
    if coarse:
        curve, half = np.round(curve), np.round(half)
    boxes = Obstacles(
        np.array([[shift, 0.0, shift]]),
        (np.eye(3) if coarse else turned(seed))[None],
        scale * half[None],
        scale * chance.choice([0.0, 0.5], 1).astype(np.float64),
        np.zeros(1, dtype=np.int64),
        np.zeros(1, dtype=np.bool_),
    )
    curve = scale * curve + [shift, 0.0, shift]
    found = obstacle_gaps(curve[None], np.zeros(1), boxes, np.zeros((1, 2), np.int64), np.inf)
    distance = sampled(curve, boxes, 0)
    noise = 1e-14 * max(scale, shift)
    assert found.lower[0] <= max(distance, -boxes.roundings[0]) + noise
    room = max(0.01 * abs(found.upper[0]), 1e-5 * boxes.roundings[0], 1e-8 * scale)
    assert found.upper[0] - found.lower[0] <= room + noise
    assert found.upper[0] >= found.lower[0]


@pytest.mark.parametrize("gap", [0.3, 0.01, 1e-4])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_a_known_gap_above_a_box_is_found_within_a_hundredth(gap: float, seed: int) -> None:
    chance, turn = np.random.default_rng(seed), turned(seed)
    curve = chance.uniform(-1, 1, (4, 3)) * [1, 1, 0] + [0, 0, 2 + 0.1 + gap]
    boxes = Obstacles(
        np.zeros((1, 3)),
        turn.T[None].copy(),
        np.array([[1.0, 1, 2]]),
        np.zeros(1),
        np.zeros(1, int),
        np.zeros(1, bool),
    )
    found = obstacle_gaps(
        (curve @ turn)[None], np.array([0.1]), boxes, np.zeros((1, 2), np.int64), np.inf
    )
    assert 0.99 * gap - 1e-12 <= found.lower[0] <= gap + 1e-12
    assert (found.places[0] @ turn.T)[2] == pytest.approx(2 + gap / 2, abs=0.01 * gap + 1e-6)


def pairs_near(placement: Placement, curves: Floats, passable: list[list[int]]) -> list[list[int]]:
    boxes = obstacles_of(placement)
    count = len(curves)
    found = near_obstacles(
        curves,
        np.arange(count),
        np.full(count, 0.1),
        boxes,
        np.array(passable, dtype=np.int64).reshape(-1, 2),
        0.05,
    )
    return [[segment, int(boxes.items[box])] for segment, box in found.tolist()]


def test_segments_are_paired_with_the_items_beside_them() -> None:
    scene = furnished([CUBE, CUBE, Sphere(0.5)], [[0, 0, 0], [5, 0, 0], [0, 5, 0]])
    curves = np.stack([LINE, LINE * 0.1, LINE])
    curves += np.array([[0, 0, 0.6], [0, 5, 0], [0, 0, 0.7]])[:, None]
    assert pairs_near(scene, curves, []) == [[0, 0], [1, 2]]


def test_what_a_hyperedge_may_pass_is_not_in_its_way_nor_is_the_label() -> None:
    scene = furnished([CUBE], [[0, 0, 0]], labels=[label("beside", (1.0, 0.0, 0.0))])
    curves = np.stack([LINE, LINE])
    assert pairs_near(scene, curves, [[1, 0]]) == [[0, 0], [0, 0]]


def test_only_active_segments_are_looked_at() -> None:
    boxes = obstacles_of(furnished([CUBE], [[0, 0, 0]]))
    found = near_obstacles(
        np.stack([LINE, LINE]),
        np.arange(2),
        np.full(2, 0.1),
        boxes,
        np.zeros((0, 2), np.int64),
        0.05,
        np.array([False, True]),
    )
    assert found.tolist() == [[1, 0]]
