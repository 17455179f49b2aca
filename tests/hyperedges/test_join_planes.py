from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.join_planes import choose_join_planes
from app.placement.placement import Placement
from tests.hyperedges.scenes import placement

CLEARANCE = 0.05
RADIUS = 0.08


def choose(scene: Placement, given_heights: Floats | None = None) -> Floats:
    if given_heights is None:
        given_heights = np.full(len(scene.radii), np.nan)
    return choose_join_planes(scene, CLEARANCE, given_heights)


def scattered(count: int, width: float, reach: float, seed: int) -> Placement:
    chance = np.random.default_rng(seed)
    arities = chance.integers(2, 6, count)
    starts = np.concatenate([[0], np.cumsum(arities)]).tolist()
    middles = np.repeat(chance.uniform(0, width, (count, 2)), arities, axis=0)
    spread = chance.uniform(-reach, reach, middles.shape)
    return placement(np.column_stack([middles + spread, np.zeros(len(middles))]), starts)


def boxes(scene: Placement) -> tuple[Floats, Floats]:
    at, starts = scene.attachment_positions, scene.attachment_starts[:-1]
    return np.minimum.reduceat(at, starts), np.maximum.reduceat(at, starts)


@pytest.mark.parametrize("reach", [0.5, 3.0, 10.0])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_overlapping_footprints_lie_a_tube_and_a_gap_apart(reach: float, seed: int) -> None:
    scene = scattered(40, 10.0, reach, seed)
    planes = choose(scene)
    lows, highs = boxes(scene)
    for a, b in itertools.combinations(range(len(planes)), 2):
        if (lows[a, :2] <= highs[b, :2]).all() and (lows[b, :2] <= highs[a, :2]).all():
            assert abs(planes[a] - planes[b]) >= 2 * RADIUS + CLEARANCE


def test_planes_lie_above_their_own_attachments() -> None:
    scene = placement(np.array([[0, 0, 0], [3, 0, 5], [9, 9, -2], [9, 8, -3]]), [0, 2, 4])
    planes = choose(scene)
    assert planes[0] > 5 + 2 * RADIUS
    assert -2 + 2 * RADIUS < planes[1] < 0


def test_a_short_hyperedge_stays_below_a_long_one() -> None:
    scene = placement(np.array([[-9, 0, 0], [9, 0, 0], [-0.5, 0, 0], [0.5, 0, 0]]), [0, 2, 4])
    long, short = choose(scene)
    assert short < long


def test_hyperedges_side_by_side_share_a_height() -> None:
    points = [[x, y, 0] for x in range(0, 60, 3) for y in (0, 1)]
    planes = choose(placement(np.array(points), list(range(0, 41, 2))))
    assert len(set(planes.tolist())) == 1


@pytest.mark.parametrize("span", [1.0, 3.0, 6.0, 15.0])
def test_an_arch_is_neither_flat_nor_a_hoop(span: float) -> None:
    (plane,) = choose(placement(np.array([[0, 0, 0], [span, 0, 0]]), [0, 2]))
    assert 0.12 * span < plane < 0.9 * span


def test_an_item_on_the_way_is_passed_above() -> None:
    ends = np.array([[-4, 0, 0.5], [4, 0, 0.5]])
    block, size = np.array([[0, 0, 2.0]]), np.array([[1, 1, 4.0]])
    free = choose(placement(ends, [0, 2]))[0]
    above = choose(placement(ends, [0, 2], items=block, sizes=size))[0]
    aside = choose(placement(ends + np.array([0, 7, 0]), [0, 2], items=block, sizes=size))[0]
    peak = 0.5 + 0.75 * (above - 0.5)
    assert free == aside < above
    assert peak >= 4 + RADIUS + CLEARANCE


def test_a_tower_is_not_jumped() -> None:
    ends = np.array([[-1, 0, 0.5], [1, 0, 0.5]])
    tower, size = np.array([[0, 0, 500.0]]), np.array([[1, 1, 1000.0]])
    assert choose(placement(ends, [0, 2], items=tower, sizes=size))[0] < 5


def test_a_turned_item_is_as_high_as_it_stands() -> None:
    ends = np.array([[-4, 0, 0.5], [4, 0, 0.5]])
    lying = placement(ends, [0, 2], items=np.zeros((1, 3)), sizes=np.array([[8.0, 1, 1]]))
    quarter = np.array([[0, np.sqrt(0.5), 0, np.sqrt(0.5)]])
    standing = Placement(
        **{**{name: getattr(lying, name) for name in lying.__slots__}, "rotations": quarter}
    )
    assert choose(standing)[0] > choose(lying)[0]


def test_given_heights_stay_and_are_kept_clear_of() -> None:
    scene = scattered(30, 1.0, 5.0, 1)
    heights = np.full(30, np.nan)
    heights[:10] = np.linspace(1.0, 3.0, 10) + 0.01
    planes = choose(scene, heights)
    assert planes[:10].tolist() == heights[:10].tolist()
    assert np.isfinite(planes).all()
    assert np.isnan(heights[10:]).all()
    lows, highs = boxes(scene)
    for a in range(30):
        for b in range(10, 30):
            over = (lows[a, :2] <= highs[b, :2]).all() and (lows[b, :2] <= highs[a, :2]).all()
            assert a == b or not over or abs(planes[a] - planes[b]) > 1e-9


def test_planes_do_not_depend_on_where_the_program_lies() -> None:
    scene = scattered(50, 10.0, 2.0, 2)
    moved = placement(
        scene.attachment_positions + np.array([512, -1024, 0]), scene.attachment_starts.tolist()
    )
    np.testing.assert_allclose(choose(scene), choose(moved), atol=1e-12)


def test_heights_far_apart_are_no_trouble() -> None:
    points = np.array([[0, 0, -1e6], [1, 1, -1e6], [0, 0, 1e6], [1, 1, 1e6]])
    low, high = choose(placement(points, [0, 2, 4]))
    assert -1e6 < low < -1e6 + 3
    assert 1e6 < high < 1e6 + 3


def test_coincident_attachments_still_rise() -> None:
    planes = choose(placement(np.zeros((6, 3)), [0, 2, 4, 6]))
    assert np.diff(np.sort(planes)).min() >= 2 * RADIUS + CLEARANCE
    assert planes.min() >= 4 * RADIUS


def test_more_hyperedges_than_levels_share() -> None:
    count = 1100
    planes = choose(
        placement(np.tile([[0.0, 0, 0], [5, 5, 0]], (count, 1)), list(range(0, 2 * count + 1, 2)))
    )
    assert np.isfinite(planes).all()
    assert len(set(planes.tolist())) == 1024
