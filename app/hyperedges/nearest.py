"""A k-d tree of points that come and go, and each one's nearest among the older ones (Numba).

Points are rows of one array and are named by row number; a larger number is newer.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices

BUCKET = 12
"""Points in a leaf before it is split."""

DEEPEST = 200
"""Leaves so deep are not split further: their points differ in their last digits only."""


class Tree(NamedTuple):
    """Nodes with the axis that splits them (-1: a leaf) and where.

    A leaf's points are a linked list, from the newest (largest number) to the oldest. ``used``
    holds the number of nodes.
    """

    axes: NDArray[np.int8]
    splits: Floats
    children: Indices
    heads: Indices
    sizes: Indices
    older: Indices
    alive: NDArray[np.bool_]
    used: Indices


@njit(cache=True)
def squared_distance(points: Floats, i: int, j: int, dimensions: int) -> float:
    """Squared distance of points i and j in their first ``dimensions`` coordinates."""
    total = 0.0
    for axis in range(dimensions):
        difference = points[i, axis] - points[j, axis]
        total += difference * difference
    return total


@njit(cache=True)
def empty_tree(capacity: int) -> Tree:
    """A tree for points numbered below ``capacity``."""
    nodes = 2 * capacity + 1
    return Tree(
        np.full(nodes, -1, np.int8),
        np.zeros(nodes),
        np.zeros((nodes, 2), np.int64),
        np.full(nodes, -1, np.int64),
        np.zeros(nodes, np.int64),
        np.full(capacity, -1, np.int64),
        np.zeros(capacity, np.bool_),
        np.ones(1, np.int64),
    )


@njit(cache=True)
def _empty_leaf(tree: Tree, node: int) -> None:
    tree.axes[node] = -1
    tree.heads[node] = -1
    tree.sizes[node] = 0


@njit(cache=True)
def _put_first(tree: Tree, node: int, i: int) -> None:
    tree.older[i] = tree.heads[node]
    tree.heads[node] = i
    tree.sizes[node] += 1


@njit(cache=True)
def _split(tree: Tree, points: Floats, node: int, dimensions: int) -> None:
    """Halve a full leaf across its longest side; one whose points coincide stays whole."""
    first = tree.heads[node]
    axis = -1
    longest = 0.0
    middle = 0.0
    for candidate in range(dimensions):
        low = high = points[first, candidate]
        i = first
        while i >= 0:
            low = min(low, points[i, candidate])
            high = max(high, points[i, candidate])
            i = tree.older[i]
        if high - low > longest and low < low + (high - low) / 2 < high:
            axis = candidate
            longest = high - low
            middle = low + (high - low) / 2
    if axis < 0:
        return
    left = tree.used[0]
    tree.used[0] += 2
    _empty_leaf(tree, left)
    _empty_leaf(tree, left + 1)
    # Turned around and put first one by one, the points keep their order.
    oldest = -1
    i = first
    while i >= 0:
        after = tree.older[i]
        tree.older[i] = oldest
        oldest = i
        i = after
    i = oldest
    while i >= 0:
        after = tree.older[i]
        _put_first(tree, left if points[i, axis] < middle else left + 1, i)
        i = after
    _empty_leaf(tree, node)
    tree.axes[node] = axis
    tree.splits[node] = middle
    tree.children[node, 0] = left
    tree.children[node, 1] = left + 1


@njit(cache=True)
def _leaf_of(tree: Tree, points: Floats, i: int) -> int:
    node = 0
    while tree.axes[node] >= 0:
        node = tree.children[node, 0 if points[i, tree.axes[node]] < tree.splits[node] else 1]
    return node


@njit(cache=True)
def insert(tree: Tree, points: Floats, i: int, dimensions: int) -> None:
    """Add point i, whose number is larger than all in the tree."""
    node = 0
    depth = 0
    while tree.axes[node] >= 0:
        side = 0 if points[i, tree.axes[node]] < tree.splits[node] else 1
        node = tree.children[node, side]
        depth += 1
    _put_first(tree, node, i)
    tree.alive[i] = True
    full = tree.sizes[node] >= BUCKET and tree.sizes[node] % BUCKET == 0
    if full and depth < DEEPEST and tree.used[0] + 2 <= len(tree.axes):
        _split(tree, points, node, dimensions)


@njit(cache=True)
def rebuild(tree: Tree, points: Floats, living: Indices, dimensions: int) -> None:
    """Fill the tree anew with ``living``, ascending numbers of points."""
    tree.used[0] = 1
    _empty_leaf(tree, 0)
    for i in living:
        insert(tree, points, i, dimensions)


@njit(cache=True)
def nearest(tree: Tree, points: Floats, i: int, dimensions: int) -> tuple[int, float]:
    """The living point older than i that is nearest to it, and their squared distance; or -1.

    Of equally near points the oldest is taken, but of coincident ones the newest: so the first pair
    of a set is always somebody's, and a heap of coincident points never turns over as a whole.
    Dead points on the way are taken out of their leaves.
    """
    best = np.inf
    partner = -1
    nodes = np.empty(DEEPEST + 2, np.int64)
    gaps = np.empty((DEEPEST + 2, 3))
    nodes[0] = 0
    gaps[0] = 0.0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        gap_x, gap_y, gap_z = gaps[waiting, 0], gaps[waiting, 1], gaps[waiting, 2]
        if gap_x * gap_x + gap_y * gap_y + gap_z * gap_z > best:
            continue
        axis = tree.axes[node]
        while axis >= 0:
            beyond = points[i, axis] - tree.splits[node]
            side = 0 if beyond < 0.0 else 1
            nodes[waiting] = tree.children[node, 1 - side]
            gaps[waiting, 0] = gap_x
            gaps[waiting, 1] = gap_y
            gaps[waiting, 2] = gap_z
            gaps[waiting, axis] = beyond
            waiting += 1
            node = tree.children[node, side]
            axis = tree.axes[node]
        previous = -1
        j = tree.heads[node]
        if tree.sizes[node] > BUCKET and tree.alive[i] and node == _leaf_of(tree, points, i):
            # A long list of coincident points: begin at i itself.
            previous = i
            j = tree.older[i]
        while j >= 0:
            after = tree.older[j]
            if not tree.alive[j]:
                if previous < 0:
                    tree.heads[node] = after
                else:
                    tree.older[previous] = after
                tree.sizes[node] -= 1
            else:
                previous = j
                if j < i:
                    distance = squared_distance(points, i, j, dimensions)
                    if distance == 0.0:
                        return j, distance
                    if distance < best or (distance == best and j < partner):
                        best = distance
                        partner = j
            j = after
    return partner, best
