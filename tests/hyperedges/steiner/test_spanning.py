from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.steiner.boruvka import spanning_edges
from app.hyperedges.steiner.spanning import FEW, span
from tests.hyperedges.scenes import troubles
from tests.hyperedges.steiner.measures import is_tree, spanning_length


def spanned(points: Floats) -> tuple[Floats, Indices, Indices, float]:
    n = len(points)
    at = points.copy()
    order, parents = np.zeros(n, np.int64), np.zeros(n, np.int64)
    length = span(at, n, order, parents)
    return at, order, parents, length


@pytest.mark.parametrize("count", [2, 3, 40, FEW + 100])
def test_no_spanning_tree_is_shorter(count: int) -> None:
    for name, points in troubles(count).items():
        at, _, parents, length = spanned(points)
        assert length == pytest.approx(spanning_length(points), rel=1e-9), name
        edges = np.linalg.norm(at[1:] - at[parents[1:]], axis=1)
        assert length == pytest.approx(edges.sum(), rel=1e-9), name


@pytest.mark.parametrize("count", [40, FEW + 100])
def test_every_point_has_a_parent_before_it(count: int) -> None:
    points = troubles(count)["few places"]
    at, order, parents, _ = spanned(points)
    assert sorted(order) == list(range(count))
    assert order[0] == 0
    assert (parents[1:] < np.arange(1, count)).all()
    assert (at == points[order]).all()


def test_links_are_a_tree() -> None:
    for name, points in troubles(300).items():
        assert is_tree(spanning_edges(points, 300), 300), name
