"""Halving a set of points by a plane: what search trees are built from (Numba).

A set is a stretch of an array of row numbers, ``order[begin:end]``.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices


@njit(cache=True)
def bound(points: Floats, order: Indices, begin: int, end: int, low: Floats, high: Floats) -> None:
    """Write the smallest and largest coordinates of a set that is not empty."""
    for axis in range(len(low)):
        low[axis] = np.inf
        high[axis] = -np.inf
    for place in range(begin, end):
        for axis in range(len(low)):
            coordinate = points[order[place], axis]
            low[axis] = min(low[axis], coordinate)
            high[axis] = max(high[axis], coordinate)


@njit(cache=True)
def halve(
    points: Floats, order: Indices, begin: int, end: int, low: Floats, high: Floats
) -> tuple[int, int, float]:
    """Order a set so that points below the middle of its longest side come first.

    Returns where the others begin, the axis, and the largest coordinate that counts as below.
    Where all points are equal the set stays whole: the others begin at its end.
    """
    widest = 0
    for axis in range(1, len(low)):
        if high[axis] - low[axis] > high[widest] - low[widest]:
            widest = axis
    if not high[widest] > low[widest]:
        return end, widest, high[widest]
    middle = low[widest] + (high[widest] - low[widest]) / 2.0
    if middle >= high[widest]:
        # Neighbouring numbers, with nothing in between.
        middle = low[widest]
    front, back = begin, end - 1
    while front <= back:
        if points[order[front], widest] <= middle:
            front += 1
        else:
            order[front], order[back] = order[back], order[front]
            back -= 1
    return front, widest, middle
