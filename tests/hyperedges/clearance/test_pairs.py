from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance import pairs
from app.hyperedges.clearance.pairs import boxes, gaps, near_pairs
from tests.hyperedges.clearance.curves import pairs_of_curves, points_at, sampled_distance

LINE = np.column_stack([np.arange(4.0), np.zeros((4, 2))])


def near_pairs_in_a_loop(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    active: NDArray[np.bool_],
) -> list[list[int]]:
    found = []
    lows, highs = control_points.min(axis=1), control_points.max(axis=1)
    for i in range(len(radii)):
        for j in range(i + 1, len(radii)):
            room = np.maximum(lows[i] - highs[j], lows[j] - highs[i])
            near = bool((room < radii[i] + radii[j] + clearance).all())
            if near and owners[i] != owners[j] and (active[i] or active[j]):
                found.append([i, j])
    return found


@pytest.mark.parametrize("shape", ["spread", "flat", "long tubes", "one place", "far away"])
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(0, 60))
@settings(max_examples=20)
def test_a_plain_loop_finds_the_same_pairs(shape: str, seed: int, count: int) -> None:
    chance = np.random.default_rng(seed)
    curves = chance.uniform(0, 9, (count, 1, 3)) + chance.uniform(-1, 1, (count, 4, 3))
    if shape == "flat":
        curves[..., 2] = 0.0
    elif shape == "long tubes":
        curves[..., 0] *= chance.choice([1.0, 1000.0], (count, 1))
    elif shape == "one place":
        curves[:] = 1.0
    elif shape == "far away":
        curves += 1e5
    owners = np.sort(chance.integers(0, max(count // 3, 1), count))
    radii = chance.uniform(0.1, 0.2, count)
    active: NDArray[np.bool_] = chance.random(count) < 0.5
    everyone = np.ones(count, dtype=np.bool_)
    for who, some in ((None, everyone), (active, active)):
        found = near_pairs(curves, owners, radii, 0.05, who)
        assert found.tolist() == near_pairs_in_a_loop(curves, owners, radii, 0.05, some)


def test_many_segments_are_found_as_in_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    chance = np.random.default_rng(1)
    curves = chance.uniform(0, 60, (20_000, 1, 3)) + chance.uniform(-1, 1, (20_000, 4, 3))
    owners, radii = np.arange(20_000) // 4, np.full(20_000, 0.1)
    found = near_pairs(curves, owners, radii, 0.05)
    measured = gaps(curves, radii, found, 0.05)
    assert len(found) > 10_000
    monkeypatch.setattr("os.cpu_count", lambda: 1)
    np.testing.assert_array_equal(found, near_pairs(curves, owners, radii, 0.05))
    np.testing.assert_array_equal(measured.lower, gaps(curves, radii, found, 0.05).lower)


def test_boxes_hold_the_tubes() -> None:
    curves = np.random.default_rng(2).uniform(-5, 5, (30, 4, 3))
    radii = np.full(30, 0.3)
    found = boxes(curves, radii)
    for k in range(30):
        points = points_at(curves[k], np.linspace(0, 1, 50))
        assert (points - 0.3 >= found[k, :3]).all()
        assert (points + 0.3 <= found[k, 4:7]).all()


@given(pair=pairs_of_curves(), radii=st.tuples(st.floats(0, 2), st.floats(0, 2)))
@settings(max_examples=300)
def test_gaps_are_distances_less_both_radii(
    pair: tuple[Floats, Floats], radii: tuple[float, float]
) -> None:
    found = gaps(np.stack(pair), np.array(radii), np.array([[0, 1]]), np.inf)
    distance = sampled_distance(*pair) - sum(radii)
    assert found.lower[0] <= distance + 1e-9
    assert found.lower[0] <= found.upper[0]
    extent = float(np.ptp(np.stack(pair), axis=(0, 1)).max())
    room = max(0.01 * abs(found.upper[0]), 1e-5 * sum(radii), 1e-3 * extent)
    assert found.upper[0] - found.lower[0] <= room + 1e-9


@pytest.mark.parametrize("gap", [0.3, 0.05, 1e-3, -0.01, -0.2])
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_a_known_gap_between_surfaces_is_found_within_a_hundredth(gap: float, seed: int) -> None:
    chance = np.random.default_rng(seed)
    first, second = chance.uniform(-3, 3, (2, 4, 3)) * [1, 1, 0]
    first, second = first - points_at(first, np.array([0.3])), second - second[0]
    second[:, 2] = gap + 0.1 + 0.2
    found = gaps(np.stack([first, second]), np.array([0.1, 0.2]), np.array([[0, 1]]), np.inf)
    assert gap - 0.01 * abs(gap) - 1e-5 <= found.lower[0] <= gap + 1e-12
    # The first tube ends a gap below the second: they have the same height at the place.
    assert found.places[0, 2] == pytest.approx(0.1 + gap / 2, abs=0.003 + abs(gap) * 0.02)


def test_the_place_is_halfway_between_the_surfaces() -> None:
    lines = np.stack([LINE, LINE[:, [1, 0, 2]] + [2.0, 0, 1.0]])
    found = gaps(lines, np.array([0.1, 0.3]), np.array([[0, 1]]), np.inf)
    np.testing.assert_allclose(found.places[0], [2.0, 0, 0.4], atol=1e-9)
    np.testing.assert_allclose(found.at[0], [2 / 3, 0.0], atol=1e-9)


def test_tubes_that_share_an_attachment_overlap_there() -> None:
    lines = np.stack([LINE, LINE[:, [1, 0, 2]]])
    found = gaps(lines, np.array([0.1, 0.1]), np.array([[0, 1]]), 0.05)
    assert found.lower[0] == pytest.approx(-0.2)
    assert found.upper[0] == pytest.approx(-0.2, abs=1e-5)
    np.testing.assert_allclose(found.places[0], 0.0, atol=1e-9)


@pytest.mark.parametrize("beyond", [1e-3, 1e-5])
def test_a_pair_is_decided_a_little_above_and_below_what_is_enough(beyond: float) -> None:
    curve = np.array([[0, 0, 0], [1, 2, 0], [2, -2, 0], [3, 0, 0.0]])
    for sign in (-1, 1):
        lines = np.stack([curve, curve + np.array([0, 0, 0.25 + sign * beyond])])
        found = gaps(lines, np.array([0.1, 0.1]), np.array([[0, 1]]), 0.05)
        assert (found.lower[0] >= 0.05) == (sign > 0)
        assert (found.upper[0] < 0.05) == (sign < 0)


@pytest.mark.parametrize(("at_once", "many"), [(1, 1), (3, 20), (1000, 1000)])
def test_in_parts_there_are_the_same_close_pairs(
    monkeypatch: pytest.MonkeyPatch, at_once: int, many: int
) -> None:
    monkeypatch.setattr(pairs, "ASKED_AT_ONCE", at_once)
    monkeypatch.setattr(pairs, "MANY", many)
    chance = np.random.default_rng(5)
    curves = chance.uniform(0.0, 6.0, (400, 1, 3)) + chance.uniform(-1.0, 1.0, (400, 4, 3))
    owners, radii = np.repeat(np.arange(100), 4), np.full(400, 0.1)
    for active in (None, chance.uniform(size=400) < 0.3):
        near = near_pairs(curves, owners, radii, 0.2, active)
        found = gaps(curves, radii, near, 0.2)
        close = found.lower < 0.2
        assert 50 < close.sum() < len(near)
        made, apart = pairs.close_pairs(curves, owners, radii, 0.2, active)
        np.testing.assert_array_equal(made, near[close])
        np.testing.assert_array_equal(apart.lower, found.lower[close])
        np.testing.assert_array_equal(apart.places, found.places[close])
