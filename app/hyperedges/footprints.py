"""Rectangles seen from above, and which of them overlap another one (Numba).

A rectangle (smallest x, largest x, smallest y, largest y) is a point in four dimensions, and those
that overlap a given rectangle are the points in a box there. So a tree over these points answers
with whole branches: all of one overlap, or none, or its halves are looked at.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.partition import bound, halve

FULL = 4
"""As many rectangles a leaf has, at most, unless they are equal."""

NONE, SOME, ALL = 0, 1, 2
"""How many of a node's rectangles overlap."""


class Footprints(NamedTuple):
    """A tree over n rectangles; node 0 is the root, and children are numbered after parents.

    ``rectangles`` (n, 4); ``order`` (n,): the rectangles below node k are those from ``begins[k]``
    to ``ends[k]``; ``lows`` and ``highs`` (m, 4): their smallest and largest numbers;
    ``children`` (m,): the first, which the second follows, -1 in leaves; ``parents`` (m,);
    ``leaves`` (n,): the leaf of each rectangle.
    """

    rectangles: Floats
    order: Indices
    begins: Indices
    ends: Indices
    lows: Floats
    highs: Floats
    children: Indices
    parents: Indices
    leaves: Indices


@njit(cache=True)
def plant(rectangles: Floats) -> Footprints:
    """The tree over ``rectangles`` (n, 4), of which there is one or more."""
    count = len(rectangles)
    room = 2 * count
    order = np.arange(count)
    begins, ends = np.zeros(room, np.int64), np.full(room, count)
    lows, highs = np.empty((room, 4)), np.empty((room, 4))
    children, parents = np.full(room, -1), np.full(room, -1)
    leaves = np.zeros(count, np.int64)
    nodes = 1
    node = 0
    while node < nodes:
        begin, end = begins[node], ends[node]
        bound(rectangles, order, begin, end, lows[node], highs[node])
        middle = end
        if end - begin > FULL:
            middle, _, _ = halve(rectangles, order, begin, end, lows[node], highs[node])
        if middle == end:
            for place in range(begin, end):
                leaves[order[place]] = node
        else:
            children[node] = nodes
            parents[nodes], parents[nodes + 1] = node, node
            begins[nodes], ends[nodes] = begin, middle
            begins[nodes + 1], ends[nodes + 1] = middle, end
            nodes += 2
        node += 1
    return Footprints(
        rectangles,
        order,
        begins[:nodes],
        ends[:nodes],
        lows[:nodes],
        highs[:nodes],
        children[:nodes],
        parents[:nodes],
        leaves,
    )


@njit(cache=True)
def overlap(a: Floats, b: Floats) -> bool:
    """Whether two rectangles (4,) have a point in common."""
    return bool(a[0] <= b[1] and b[0] <= a[1] and a[2] <= b[3] and b[2] <= a[3])


@njit(cache=True)
def share(low: Floats, high: Floats, rectangle: Floats) -> int:
    """How many of the rectangles between ``low`` (4,) and ``high`` (4,) overlap another."""
    if (
        low[0] > rectangle[1]
        or high[1] < rectangle[0]
        or low[2] > rectangle[3]
        or high[3] < rectangle[2]
    ):
        return NONE
    if (
        high[0] <= rectangle[1]
        and low[1] >= rectangle[0]
        and high[2] <= rectangle[3]
        and low[3] >= rectangle[2]
    ):
        return ALL
    return SOME


@njit(cache=True)
def _tops(footprints: Footprints, heights: Floats) -> Floats:
    """The greatest height below each node."""
    _, order, begins, ends, _, _, children, parents, _ = footprints
    tops = np.full(len(children), -np.inf)
    for node in range(len(children) - 1, -1, -1):
        if children[node] < 0:
            for place in range(begins[node], ends[node]):
                tops[node] = max(tops[node], heights[order[place]])
        if node > 0:
            tops[parents[node]] = max(tops[parents[node]], tops[node])
    return tops


@njit(cache=True)
def highest_below(footprints: Footprints, heights: Floats, rectangles: Floats) -> Floats:
    """For each of other rectangles (k, 4), the greatest of the ``heights`` (n,) that overlap it.

    Minus infinity where none does.
    """
    own, order, begins, ends, lows, highs, children, _, _ = footprints
    tops = _tops(footprints, heights)
    found = np.full(len(rectangles), -np.inf)
    stack = np.empty(len(children) + 1, np.int64)
    for k in range(len(rectangles)):
        stack[0] = 0
        waiting = 1
        while waiting > 0:
            waiting -= 1
            node = stack[waiting]
            if tops[node] <= found[k]:
                continue
            how_many = share(lows[node], highs[node], rectangles[k])
            if how_many == ALL:
                found[k] = tops[node]
            elif how_many == SOME and children[node] >= 0:
                stack[waiting] = children[node]
                stack[waiting + 1] = children[node] + 1
                waiting += 2
            elif how_many == SOME:
                for i in order[begins[node] : ends[node]]:
                    if overlap(own[i], rectangles[k]):
                        found[k] = max(found[k], heights[i])
    return found
