"""The closest pair of a changing set of points, again and again: the paper's CLOSEST (Numba).

Of pairs equally close, the one with the smallest numbers comes first: by its smaller number, then
by its larger. Points added later have larger numbers.

Coincident points come first, from lists of those at one place. When no two points coincide any
more, each living point has one entry in a heap: the pair that came first when it last looked. A
pair is found stale when it comes to the top and one of its points has died; then the other looks
anew. Whichever of two points came later saw the other, so no pair is missed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.coincident import Places, add_to_place, empty_places, take_coincident
from app.hyperedges.nearest import (
    CHILD,
    COUNT,
    LEAF,
    Tree,
    empty_tree,
    insert,
    nearest,
    precedes,
    rebuild,
    remove,
    squared_distance,
)


class Pairs(NamedTuple):
    """A set of points, and what is known of its closest pairs.

    ``heap`` (n,) of points with ``keys`` (n,), the squared distances to their ``partners`` (n,);
    ``sizes`` (5,): entries in the heap, living points, living points when the tree was built last
    (0: not yet), points in all, coordinates that count.
    """

    places: Places
    tree: Tree
    heap: Indices
    keys: Floats
    partners: Indices
    sizes: Indices


@njit(cache=True)
def closest_directly(
    points: Floats, living: Indices, count: int, dimensions: int
) -> tuple[int, int]:
    """Places in ``living[:count]`` (ascending) of the closest pair, by looking at every pair."""
    best = np.inf
    first, second = 0, 1
    for a in range(count):
        for b in range(a + 1, count):
            distance = squared_distance(points, living[a], living[b], dimensions)
            if distance < best:
                best = distance
                first, second = a, b
    return first, second


@njit(cache=True)
def start(points: Floats, count: int, dimensions: int) -> Pairs:
    """The pairs of points 0 to ``count - 1``; ``points`` has rows for those to be added."""
    capacity = len(points)
    places = empty_places(capacity, dimensions)
    for i in range(count):
        add_to_place(places, points, i)
    return Pairs(
        places,
        empty_tree(capacity, count),
        np.empty(capacity, np.int64),
        np.empty(capacity),
        np.full(capacity, -1, np.int64),
        np.array([0, count, 0, count, dimensions]),
    )


@njit(cache=True)
def take_closest(pairs: Pairs, points: Floats) -> tuple[int, int]:
    """The closest pair, smaller number first; both points leave the set."""
    homes, partners = pairs.tree.homes, pairs.partners
    pairs.sizes[1] -= 2
    if pairs.sizes[2] == 0:
        first, second = take_coincident(pairs.places)
        if first >= 0:
            return first, second
        _look_all(pairs, points)
    while True:
        i = _pop(pairs.heap, pairs.keys, partners, pairs.sizes)
        if homes[i] < 0:
            continue
        j = partners[i]
        if homes[j] < 0:
            _look(pairs, points, i)
            continue
        remove(pairs.tree, i)
        remove(pairs.tree, j)
        return min(i, j), max(i, j)


@njit(cache=True)
def add(pairs: Pairs, points: Floats, i: int) -> None:
    """Point i, with a larger number than all before, joins the set."""
    pairs.sizes[1] += 1
    pairs.sizes[3] = i + 1
    if pairs.sizes[2] == 0:
        add_to_place(pairs.places, points, i)
        return
    # A tree that is mostly dead is slow to search.
    if 2 * pairs.sizes[1] < pairs.sizes[2] or not insert(pairs.tree, points, i, pairs.sizes[4]):
        pairs.tree.homes[i] = 0
        _rebuild(pairs, points)
    _look(pairs, points, i)


@njit(cache=True)
def living_points(pairs: Pairs) -> Indices:
    """The numbers of the points in the set, ascending."""
    count = pairs.sizes[3]
    if pairs.sizes[2] == 0:
        return np.flatnonzero(pairs.places.alive[:count])
    return np.flatnonzero(pairs.tree.homes[:count] >= 0)


@njit(cache=True)
def _rebuild(pairs: Pairs, points: Floats) -> None:
    living = living_points(pairs)
    rebuild(pairs.tree, points, living, pairs.sizes[4])
    pairs.sizes[2] = len(living)


@njit(cache=True)
def _look_all(pairs: Pairs, points: Floats) -> None:
    """Every point looks for its nearest neighbour: from here on no two points coincide for long."""
    _rebuild(pairs, points)
    tree = pairs.tree
    for node in range(tree.used[0]):
        if tree.links[node, CHILD] < 0:
            # Leaf by leaf, because neighbours search the same nodes.
            for place in range(tree.links[node, COUNT]):
                _look(pairs, points, int(tree.members[tree.links[node, LEAF], place]))


@njit(cache=True)
def _look(pairs: Pairs, points: Floats, i: int) -> None:
    partner, distance = nearest(pairs.tree, points, i, pairs.sizes[4])
    if partner >= 0:
        pairs.partners[i] = partner
        _push(pairs.heap, pairs.keys, pairs.partners, pairs.sizes, distance, i)


@njit(cache=True)
def _before(partners: Indices, distance: float, i: int, other: float, j: int) -> bool:
    if distance != other:
        return distance < other
    a, b = partners[i], partners[j]
    return precedes(distance, min(i, a), max(i, a), other, min(j, b), max(j, b))


@njit(cache=True)
def _push(
    heap: Indices, keys: Floats, partners: Indices, sizes: Indices, distance: float, i: int
) -> None:
    place = sizes[0]
    sizes[0] += 1
    while place > 0:
        parent = (place - 1) >> 1
        if not _before(partners, distance, i, keys[parent], heap[parent]):
            break
        heap[place], keys[place] = heap[parent], keys[parent]
        place = parent
    heap[place], keys[place] = i, distance


@njit(cache=True)
def _pop(heap: Indices, keys: Floats, partners: Indices, sizes: Indices) -> int:
    top = int(heap[0])
    sizes[0] -= 1
    count = sizes[0]
    last, key = heap[count], keys[count]
    place = 0
    while 2 * place + 1 < count:
        child = 2 * place + 1
        if child + 1 < count and _before(
            partners, keys[child + 1], heap[child + 1], keys[child], heap[child]
        ):
            child += 1
        if not _before(partners, keys[child], heap[child], key, last):
            break
        heap[place], keys[place] = heap[child], keys[child]
        place = child
    heap[place], keys[place] = last, key
    return top
