"""The closest pair of a changing set of points, again and again: the paper's CLOSEST (Numba).

Pairs are compared by distance, then by their smaller number, then by their larger one, so that the
same points always give the same pair.

Each living point has at most one entry in a heap: its nearest among the older points when it last
looked. Where that one has died by the time the entry comes to the top, the point looks anew. Of two
points the newer saw the older, so no pair is missed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.nearest import (
    Tree,
    empty_tree,
    insert,
    nearest,
    rebuild,
    squared_distance,
)


class Pairs(NamedTuple):
    """``counts``: entries in the heap, living points, living points when the tree was filled."""

    tree: Tree
    heap: Indices
    partners: Indices
    distances: Floats
    counts: Indices


@njit(cache=True)
def closest_directly(
    points: Floats, living: Indices, count: int, dimensions: int
) -> tuple[int, int]:
    """Places in ``living[:count]`` (ascending) of the closest pair, by looking at every pair."""
    best = np.inf
    first = 0
    second = 1
    for a in range(count):
        for b in range(a + 1, count):
            distance = squared_distance(points, living[a], living[b], dimensions)
            if distance < best:
                best = distance
                first = a
                second = b
    return first, second


@njit(cache=True)
def _before(pairs: Pairs, i: int, j: int) -> bool:
    if pairs.distances[i] != pairs.distances[j]:
        return bool(pairs.distances[i] < pairs.distances[j])
    if pairs.partners[i] != pairs.partners[j]:
        return bool(pairs.partners[i] < pairs.partners[j])
    return i < j


@njit(cache=True)
def _push(pairs: Pairs, i: int) -> None:
    place = pairs.counts[0]
    pairs.counts[0] += 1
    while place > 0:
        parent = (place - 1) >> 1
        if not _before(pairs, i, pairs.heap[parent]):
            break
        pairs.heap[place] = pairs.heap[parent]
        place = parent
    pairs.heap[place] = i


@njit(cache=True)
def _pop(pairs: Pairs) -> int:
    top = pairs.heap[0]
    pairs.counts[0] -= 1
    count = pairs.counts[0]
    if count > 0:
        last = pairs.heap[count]
        place = 0
        while True:
            child = 2 * place + 1
            if child >= count:
                break
            if child + 1 < count and _before(pairs, pairs.heap[child + 1], pairs.heap[child]):
                child += 1
            if not _before(pairs, pairs.heap[child], last):
                break
            pairs.heap[place] = pairs.heap[child]
            place = child
        pairs.heap[place] = last
    return int(top)


@njit(cache=True)
def _look(pairs: Pairs, points: Floats, i: int, dimensions: int) -> None:
    partner, distance = nearest(pairs.tree, points, i, dimensions)
    if partner >= 0:
        pairs.partners[i] = partner
        pairs.distances[i] = distance
        _push(pairs, i)


@njit(cache=True)
def start(points: Floats, count: int, dimensions: int) -> Pairs:
    """The pairs of points 0 to ``count - 1``; ``points`` has rows for those to be added."""
    capacity = len(points)
    pairs = Pairs(
        empty_tree(capacity),
        np.empty(capacity, np.int64),
        np.full(capacity, -1, np.int64),
        np.full(capacity, np.inf),
        np.array([0, count, count]),
    )
    for i in range(count):
        insert(pairs.tree, points, i, dimensions)
        _look(pairs, points, i, dimensions)
    return pairs


@njit(cache=True)
def take_closest(pairs: Pairs, points: Floats, dimensions: int) -> tuple[int, int]:
    """The closest pair, smaller number first; both points leave the set."""
    alive = pairs.tree.alive
    while True:
        i = _pop(pairs)
        if not alive[i]:
            continue
        j = pairs.partners[i]
        if not alive[j]:
            _look(pairs, points, i, dimensions)
            continue
        alive[i] = False
        alive[j] = False
        pairs.counts[1] -= 2
        return j, i


@njit(cache=True)
def add(pairs: Pairs, points: Floats, i: int, dimensions: int) -> None:
    """Point i, with a larger number than all before, joins the set."""
    pairs.counts[1] += 1
    if 2 * pairs.counts[1] < pairs.counts[2]:
        living = np.flatnonzero(pairs.tree.alive)
        rebuild(pairs.tree, points, living, dimensions)
        pairs.counts[2] = pairs.counts[1]
    insert(pairs.tree, points, i, dimensions)
    _look(pairs, points, i, dimensions)
