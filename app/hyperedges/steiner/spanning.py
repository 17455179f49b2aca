"""The minimum spanning tree of points, as an order in which to add them (Numba)."""

from __future__ import annotations

from math import sqrt

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.nearest import squared_distance
from app.hyperedges.steiner.boruvka import spanning_edges

FEW = 400
"""With so many points, looking at every pair is as fast as boxes."""


@njit(cache=True, error_model="numpy")
def span(at: Floats, n: int, order: Indices, parents: Indices) -> float:
    """Put the first n points in an order in which each has a parent before it, and write both.

    ``order`` says which they were; ``parents`` are numbered by the new order. A point and its
    parent are an edge of the minimum spanning tree. Returns its length.
    """
    if n <= FEW:
        _add_nearest(at, n, order, parents)
    else:
        _walk(spanning_edges(at, n), n, order, parents)
    places = np.empty(n, np.int64)
    old = at[:n].copy()
    for i in range(n):
        places[order[i]] = i
        for axis in range(3):
            at[i, axis] = old[order[i], axis]
    old_parents = parents[:n].copy()
    total = 0.0
    for i in range(1, n):
        parents[i] = places[old_parents[order[i]]]
        total += sqrt(squared_distance(at, i, parents[i], 3))
    return total


@njit(cache=True, error_model="numpy")
def _add_nearest(at: Floats, n: int, order: Indices, parents: Indices) -> None:
    """Prim's way: from point 0, always the nearest point next; of equally near ones the first."""
    near = np.full(n, np.inf)
    waiting = np.arange(n)
    current = 0
    order[0], parents[0] = 0, -1
    for k in range(1, n):
        # The points that wait are kept together and in order.
        kept = 0
        best = -1
        for place in range(n - k + 1):
            i = waiting[place]
            if i == current:
                continue
            waiting[kept] = i
            kept += 1
            square = squared_distance(at, i, current, 3)
            if square < near[i]:
                near[i] = square
                parents[i] = current
            if best < 0 or near[i] < near[best]:
                best = i
        order[k] = best
        current = best


@njit(cache=True, error_model="numpy")
def _walk(edges: Indices, n: int, order: Indices, parents: Indices) -> None:
    """From point 0 along the edges of a tree, one branch after another."""
    starts = np.zeros(n + 1, np.int64)
    for k in range(n - 1):
        starts[edges[k, 0] + 1] += 1
        starts[edges[k, 1] + 1] += 1
    starts = np.cumsum(starts)
    places = starts[:n].copy()
    linked = np.empty(2 * n - 2, np.int64)
    for k in range(n - 1):
        for side in range(2):
            i = edges[k, side]
            linked[places[i]] = edges[k, 1 - side]
            places[i] += 1
    stack = np.empty(n, np.int64)
    stack[0], parents[0] = 0, -1
    waiting, count = 1, 0
    while waiting > 0:
        waiting -= 1
        i = stack[waiting]
        order[count] = i
        count += 1
        for place in range(starts[i], starts[i + 1]):
            j = linked[place]
            if j != parents[i]:
                parents[j] = i
                stack[waiting] = j
                waiting += 1
