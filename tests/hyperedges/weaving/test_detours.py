from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.weaving.detours import find_way

ANYWHERE = np.zeros((2, 2))
BEND = 0.2

scatters = st.integers(0, 2**32 - 1).map(
    lambda seed: np.random.default_rng(seed).uniform([1, -4, 0.3], [9, 4, 0.8], (12, 3))
)


def way_around(discs: Floats, headings: Floats = ANYWHERE) -> Floats | None:
    """From (0, 0) to (10, 0)."""
    room = np.empty((50, 2))
    corners = find_way(0.0, 0.0, 10.0, 0.0, discs, headings, BEND, room)
    return None if corners < 0 else room[: corners + 2]


def gaps(way: Floats, discs: Floats) -> Floats:
    """How far each leg stays from each disc."""
    starts, runs = way[:-1, None], np.diff(way, axis=0)[:, None]
    to = discs[None, :, :2] - starts
    t = np.clip((to * runs).sum(-1) / (runs**2).sum(-1), 0, 1)
    return np.asarray(np.linalg.norm(to - t[..., None] * runs, axis=-1) - discs[:, 2])


def length(way: Floats) -> float:
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def test_a_free_way_is_straight() -> None:
    way = way_around(np.array([[5.0, 2.0, 1.0]]))
    assert way is not None
    assert way.tolist() == [[0, 0], [10, 0]]


def test_one_disc_is_passed_closely() -> None:
    way = way_around(np.array([[5.0, 0.2, 1.0]]))
    assert way is not None
    assert len(way) > 2
    assert (way[1:-1, 1] < 0).all(), "the shorter side is below"
    assert length(way) < 10.5


@given(scatters)
def test_ways_go_around_all_discs(discs: Floats) -> None:
    way = way_around(discs)
    assert way is not None
    assert gaps(way, discs).min() >= -1e-9
    np.testing.assert_array_equal(way[[0, -1]], [[0, 0], [10, 0]])


def test_who_is_walled_in_finds_no_way() -> None:
    around = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    ring = np.stack([2 * np.cos(around), 2 * np.sin(around), np.full(16, 0.5)], axis=1)
    assert way_around(ring) is None


def test_a_gap_in_the_wall_is_found() -> None:
    around = np.linspace(0, 2 * np.pi, 16, endpoint=False)[1:]
    ring = np.stack([2 * np.cos(around), 2 * np.sin(around), np.full(15, 0.5)], axis=1)
    back = np.concatenate([ring * [-1, 1, 1]])
    way = way_around(back)
    assert way is not None
    assert gaps(way, back).min() >= -1e-9
    assert way[:, 0].min() < -1.5, "out at the back"
