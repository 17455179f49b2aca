"""Which boxes meet, where there are so few that looking at all is quicker than a tree (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices

FEW = 65536
"""So many comparisons take less time than it takes to plant a tree."""


@njit(cache=True)
def meeting_among(boxes: Floats, groups: Indices, asked: NDArray[np.bool_]) -> Indices:
    """Pairs (m, 2) of ``boxes`` (n, 8) of different groups (n,) that meet, sorted.

    One of the two or both are ``asked`` (n,) for; the smaller number comes first.
    """
    found = np.empty((64, 2), np.int64)
    count = 0
    for i in range(len(boxes)):
        for j in range(i + 1, len(boxes)):
            if groups[i] != groups[j] and (asked[i] or asked[j]) and _meet(boxes[i], boxes[j]):
                found = _append(found, count, i, j)
                count += 1
    return found[:count]


@njit(cache=True)
def meeting_with(boxes: Floats, asking: Indices, others: Floats) -> Indices:
    """Pairs (m, 2) of a box among the numbers ``asking``, ascending, and one of ``others``."""
    found = np.empty((64, 2), np.int64)
    count = 0
    for i in asking:
        for j in range(len(others)):
            if _meet(boxes[i], others[j]):
                found = _append(found, count, i, j)
                count += 1
    return found[:count]


@njit(cache=True)
def _append(found: Indices, count: int, i: int, j: int) -> Indices:
    if count == len(found):
        more = np.empty((2 * count, 2), np.int64)
        more[:count] = found
        found = more
    found[count, 0], found[count, 1] = i, j
    return found


@njit(cache=True)
def _meet(box: Floats, other: Floats) -> bool:
    for axis in range(4):
        if box[axis] > other[axis + 4] or other[axis] > box[axis + 4]:
            return False
    return True
