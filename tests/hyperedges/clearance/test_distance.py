from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.distance import bounds
from tests.hyperedges.clearance.curves import (
    CASES,
    noise,
    pairs_of_curves,
    points_at,
    sampled_distance,
    turned,
)

LINE = np.column_stack([np.arange(4.0), np.zeros((4, 2))])


def between(first: Floats, second: Floats, at: tuple[float, float]) -> float:
    a, b = points_at(first, np.array([at[0]])), points_at(second, np.array([at[1]]))
    return float(np.linalg.norm(a - b))


@given(pair=pairs_of_curves(), enough=st.sampled_from([np.inf, 1.0, 1e-3]))
@settings(max_examples=CASES)
def test_the_lower_bound_never_exceeds_what_sampling_finds(
    pair: tuple[Floats, Floats], enough: float
) -> None:
    lower, upper, u, v = bounds(*pair, enough, 0.01)
    assert 0 <= lower <= sampled_distance(*pair) + noise(*pair)
    assert lower <= upper
    assert between(*pair, (u, v)) <= upper + noise(*pair)


@given(pair=pairs_of_curves())
@settings(max_examples=CASES // 4)
def test_bounds_close_in_on_each_other_or_on_nothing(pair: tuple[Floats, Floats]) -> None:
    lower, upper, _, _ = bounds(*pair, np.inf, 0.01)
    extent = float(np.ptp(np.concatenate(pair), axis=0).max())
    assert upper - lower <= max(0.01 * upper, 2e-3 * extent, 1e-12)


@given(pair=pairs_of_curves(), share=st.floats(0.1, 10))
@settings(max_examples=CASES // 4)
def test_it_decides_whether_curves_are_far_enough(
    pair: tuple[Floats, Floats], share: float
) -> None:
    nearest, farthest, _, _ = bounds(*pair, np.inf, 0.01)
    extent = float(np.ptp(np.concatenate(pair), axis=0).max())
    enough = share * farthest
    lower, upper, _, _ = bounds(*pair, enough, 0.01)
    if nearest > 1e-3 * extent and not 0.98 < share < 1.02:
        assert (lower >= enough) == (share < 1)
        assert (upper < enough) == (share > 1)


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1.0, 1e5])
@pytest.mark.parametrize("share", [1e-4, 0.01, 0.3, 3.0])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_curves_in_two_planes_that_cross_are_as_far_apart_as_the_planes(
    scale: float, share: float, seed: int
) -> None:
    chance = np.random.default_rng(seed)
    first, second = chance.uniform(-1, 1, (2, 4, 3)) * [1, 1, 0]
    second = second + points_at(first, np.array([0.37])) - points_at(second, np.array([0.61]))
    second[:, 2] = share
    first, second = (scale * curve @ turned(seed) for curve in (first, second))
    lower, upper, u, v = bounds(first, second, np.inf, 0.01)
    assert 0.99 * share * scale <= lower <= share * scale * (1 + 1e-9)
    assert share * scale * (1 - 1e-9) <= upper
    assert between(first, second, (u, v)) <= upper * (1 + 1e-9)


@pytest.mark.parametrize("share", [1e-3, 0.01, 0.1, 1.0])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25)
def test_parallel_curves_are_as_far_apart_as_they_run(share: float, seed: int) -> None:
    first = np.random.default_rng(seed).uniform(-1, 1, (4, 3)) * [1, 1, 0]
    first, second = first @ turned(seed), (first + np.array([0, 0, share])) @ turned(seed)
    lower, _, _, _ = bounds(first, second, np.inf, 0.01)
    assert 0.99 * share <= lower <= share * (1 + 1e-9)


@pytest.mark.parametrize("shift", [0.0, 1e5])
@pytest.mark.parametrize("gap", [0.0, 1e-4, 0.5])
def test_lines_on_one_axis_are_as_far_apart_as_the_gap_between_them(
    gap: float, shift: float
) -> None:
    first, second = LINE + shift, LINE[::-1] + np.array([3.0 + gap, 0, 0]) + shift
    lower, upper, u, v = bounds(first, second, np.inf, 0.01)
    assert 0.99 * gap - 1e-9 <= lower <= gap + 1e-9
    assert (u, v) == (1.0, 1.0)
    assert upper == pytest.approx(gap, abs=1e-9)


def test_curves_that_overlap_on_one_axis_touch() -> None:
    lower, upper, _, _ = bounds(LINE, 0.5 * LINE + [1, 0, 0], np.inf, 0.01)
    assert lower == 0
    assert upper < 1e-9


def test_an_arch_touches_the_line_that_its_top_reaches() -> None:
    arch = np.array([[0, 0, 0], [1, 0, 4], [2, 0, 4], [3, 0, 0]]) / 3.0
    lower, upper, u, _ = bounds(arch, LINE - [1.0, 0, -1.0], np.inf, 0.01)
    assert lower == 0
    assert upper < 1e-9
    assert u == pytest.approx(0.5, abs=1e-4)


@pytest.mark.parametrize("angle", [1e-3, 1e-6, 1e-9, 1e-12])
def test_lines_that_cross_at_a_tiny_angle_touch(angle: float) -> None:
    first = LINE - [1.5, 0, 0]
    lower, upper, _, _ = bounds(first, first + first[:, :1] * [0, angle, 0], np.inf, 0.01)
    assert lower == 0
    assert upper < 2e-3


def test_uneven_lines_are_measured_as_lines() -> None:
    uneven = LINE[[0, 0, 0, 3]] + [0, 0.25, 0.0]
    lower, upper, _, _ = bounds(uneven, LINE[[0, 3, 0, 3]], np.inf, 1e-6)
    assert lower == pytest.approx(0.25, rel=2e-6)
    assert upper == pytest.approx(0.25, rel=2e-6)


@pytest.mark.parametrize("far", [0.0, 1e-12, 2.5])
def test_points_are_curves_too(far: float) -> None:
    point, up = np.zeros((4, 3)), np.array([0, 0, far])
    for other in (point + up, LINE + up):
        lower, upper, _, _ = bounds(point, other, np.inf, 0.01)
        assert 0.99 * far - 1e-11 <= lower <= far <= upper + 1e-11


def test_curves_that_coincide_are_left_after_bounded_work() -> None:
    curve = np.random.default_rng(3).normal(size=(4, 3))
    for other in (curve, curve[::-1].copy(), curve + 1e-7):
        lower, upper, _, _ = bounds(curve, other, np.inf, 1e-9)
        assert 0 <= lower <= upper < 0.01
