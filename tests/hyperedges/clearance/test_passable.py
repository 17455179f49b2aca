from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.hyperedges.clearance.passable import (
    are_among,
    attached_items,
    containing_items,
    passable_items,
)
from app.solids.solid import Box
from tests.hyperedges.clearance.furniture import furnished

CUBE = Box((1.0, 1.0, 1.0), 0.05)


def test_attached_items_are_named_once() -> None:
    scene = furnished([CUBE, CUBE], [[0, 0, 0], [5, 0, 0]], attachments=[[0, 1, 1], [1, 1]])
    assert attached_items(scene).tolist() == [[0, 0], [0, 1], [1, 1]]


def test_containing_items_are_all_above() -> None:
    scene = furnished([CUBE] * 5, np.zeros((5, 3)), attachments=[[3, 4], [0, 4], [3, 2]])
    contained = replace(scene, parents=np.array([-1, 0, 1, 2, -1]))
    assert containing_items(contained).tolist() == [[0, 0], [0, 1], [0, 2], [2, 0], [2, 1], [2, 2]]
    assert passable_items(contained).tolist() == [
        *([0, item] for item in range(5)),
        *([1, item] for item in (0, 4)),
        *([2, item] for item in range(4)),
    ]


def test_without_parents_nothing_contains_anything() -> None:
    scene = furnished([CUBE] * 2, np.zeros((2, 3)), attachments=[[0, 1]])
    assert containing_items(scene).tolist() == []
    assert passable_items(scene).tolist() == attached_items(scene).tolist()
    nothing = furnished([], np.zeros((0, 3)))
    assert passable_items(nothing).tolist() == []


def test_pairs_are_found_among_others() -> None:
    some = np.array([[0, 3], [2, 0], [2, 7]])
    pairs = np.array([[2, 7], [0, 0], [0, 3], [2, 1], [7, 7]])
    assert are_among(pairs, some).tolist() == [True, False, True, False, False]
    assert are_among(pairs, some[:0]).tolist() == [False] * 5
