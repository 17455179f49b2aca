from __future__ import annotations

import numpy as np

from app.hyperedges.elastic.sides import sides_of


def test_hyperedges_that_cross_pass_on_two_sides() -> None:
    first = np.array([[-9.0, 0.0], [-8.0, -3.0], [-3.0, 4.0]])
    last = np.array([[9.0, 0.0], [8.0, 3.0], [3.0, -4.0]])
    sides = sides_of(first, last, np.arange(3), 3)
    assert sorted(sides.tolist()) == [-1.0, 1.0, 1.0]


def test_what_crosses_nothing_is_behind_the_sheet() -> None:
    first = np.array([[0.0, 0.0], [0.0, 1.0], [2.0, 1.0]])
    last = np.array([[4.0, 0.0], [2.0, 1.0], [4.0, 1.0]])
    assert sides_of(first, last, np.array([0, 1, 1]), 2).tolist() == [1.0, 1.0]
