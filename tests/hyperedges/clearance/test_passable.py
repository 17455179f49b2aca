from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.hyperedges.clearance.passable import (
    MOST_PARTS,
    are_among,
    attached_items,
    containing_items,
    passable_items,
    with_parts,
)
from app.solids.solid import Box, Tray
from tests.hyperedges.clearance.furniture import furnished

CUBE = Box((1.0, 1.0, 1.0), 0.05)
TRAY = Tray((9.0, 9.0, 1.0), 0.2, 0.2)


def test_attached_items_are_named_once() -> None:
    scene = furnished([CUBE, CUBE], [[0, 0, 0], [5, 0, 0]], attachments=[[0, 1, 1], [1, 1]])
    assert attached_items(scene).tolist() == [[0, 0], [0, 1], [1, 1]]


def test_containing_items_are_all_above() -> None:
    scene = furnished([TRAY] * 5, np.zeros((5, 3)), attachments=[[3, 4], [0, 4], [3, 2]])
    contained = replace(scene, parents=np.array([-1, 0, 1, 2, -1]))
    assert containing_items(contained).tolist() == [[0, 0], [0, 1], [0, 2], [2, 0], [2, 1], [2, 2]]
    assert passable_items(contained).tolist() == [
        *([0, item] for item in range(5)),
        *([1, item] for item in (0, 4)),
        *([2, item] for item in range(4)),
    ]


def test_parts_are_what_an_item_that_is_no_tray_holds() -> None:
    scene = furnished([TRAY, CUBE, CUBE, CUBE], np.zeros((4, 3)), attachments=[[0, 1], [3, 0]])
    contained = replace(scene, parents=np.array([-1, 0, 1, 2]))
    rows, items = with_parts(np.array([1, 0, 3]), contained)
    assert sorted(zip(rows.tolist(), items.tolist(), strict=True)) == [
        *[(0, 1), (0, 2), (0, 3)],
        *[(1, 0), (2, 3)],
    ]
    assert attached_items(contained).tolist() == [[0, 0], [0, 1], [0, 2], [0, 3], [1, 0], [1, 3]]


def test_what_holds_very_many_has_no_parts() -> None:
    count = MOST_PARTS + 2
    scene = furnished([CUBE] * count, np.zeros((count, 3)), attachments=[[0, 1]])
    contained = replace(scene, parents=np.array([-1, *[0] * (count - 1)]))
    assert attached_items(contained).tolist() == [[0, 0], [0, 1]]


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
