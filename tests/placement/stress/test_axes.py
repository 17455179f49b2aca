from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.placement.stress.axes import turned_to_axes


@given(st.integers(0, 10**6), st.sampled_from([(0, 1), (0, 2, 1)]))
def test_distances_stay_and_axes_are_in_order(seed: int, order: tuple[int, ...]) -> None:
    points = (
        np.random.default_rng(seed).normal(size=(9, len(order))) * [3.0, 1.0, 2.0][: len(order)]
    )
    turned = turned_to_axes(points, order)
    apart, now = (np.linalg.norm(x[:, None] - x[None], axis=2) for x in (points, turned))
    assert now == pytest.approx(apart)
    spread = (turned**2).sum(axis=0)[list(order)]
    assert (np.diff(spread) <= 1e-9 * spread.max()).all()
    moments = np.einsum("ni,nj->ij", turned, turned)
    assert moments == pytest.approx(np.diag(np.diag(moments)), abs=1e-8)


def test_points_at_one_place_are_left_there() -> None:
    assert (turned_to_axes(np.ones((3, 2)), (0, 1)) == 0.0).all()
