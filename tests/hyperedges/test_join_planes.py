import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.join_planes import choose_join_planes

NOTHING = np.zeros((0, 3))


def planes(attachments: list[list[float]], starts: list[int], radius: float = 0.1) -> Floats:
    hyperedges = len(starts) - 1
    return choose_join_planes(
        np.array(attachments), np.array(starts), np.full(hyperedges, radius), 0.05, NOTHING, NOTHING
    )


def test_crossing_hyperedges_get_different_planes() -> None:
    chosen = planes([[0, 0, 0], [4, 4, 0], [0, 4, 0], [4, 0, 0]], [0, 2, 4])
    assert abs(chosen[0] - chosen[1]) >= 0.25 - 1e-12


def test_distant_hyperedges_share_a_plane() -> None:
    chosen = planes([[0, 0, 0], [4, 0, 0], [0, 20, 0], [4, 20, 0]], [0, 2, 4])
    assert chosen[0] == chosen[1]


def test_planes_lie_above_items_under_them() -> None:
    chosen = choose_join_planes(
        np.array([[0.0, 0, 0.5], [8.0, 0, 0.5]]),
        np.array([0, 2]),
        np.array([0.1]),
        0.05,
        np.array([[3.0, -1, 0]]),
        np.array([[5.0, 1, 4.0]]),
    )
    assert chosen[0] > 4.0


@settings(deadline=None)
@given(st.integers(1, 40), st.integers(0, 2**32))
def test_whatever_overlaps_differs_by_a_tube(count: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    points = random.uniform(0, 10, (2 * count, 3)) * [1, 1, 0.1]
    starts = list(range(0, 2 * count + 1, 2))
    chosen = planes(points.tolist(), starts)
    assert (chosen > points[:, 2].reshape(-1, 2).max(axis=1)).all()
    lows = points.reshape(-1, 2, 3).min(axis=1)[:, :2]
    highs = points.reshape(-1, 2, 3).max(axis=1)[:, :2]
    overlap = (lows[:, None] <= highs[None]).all(axis=2) & (lows[None] <= highs[:, None]).all(
        axis=2
    )
    apart = np.abs(chosen[:, None] - chosen[None]) > 0.25 - 1e-9
    np.fill_diagonal(apart, val=True)
    assert apart[overlap].all()


def test_no_hyperedges_have_no_planes() -> None:
    assert len(choose_join_planes(NOTHING, np.array([0]), np.zeros(0), 0.05, NOTHING, NOTHING)) == 0
