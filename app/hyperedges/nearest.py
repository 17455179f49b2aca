"""A tree of points that come and go, and each point's nearest neighbour in it (Numba).

Pairs are compared by distance, then by their smaller number, then by their larger one, so that the
same points always give the same pair. Points are rows of one array and are named by row number.

Cells are halved in the middle of their longest side and shrunk to their points, so that clusters
and lines cost no more than points spread evenly. No more than `ROOM` points may coincide.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.partition import bound, halve

FULL = 16
"""As many points a leaf has when the tree is built, at most."""

ROOM = 32
"""As many points a leaf can take before it is halved."""

LOW, HIGH, SPLIT = 0, 3, 6
"""Columns of ``boxes``; the smallest and largest coordinates take three each."""

CHILD, PARENT, AXIS, COUNT, LEAF = 0, 1, 2, 3, 4
"""Columns of ``links``."""

Numbers: TypeAlias = NDArray[np.int32]
"""Half as wide as `Indices`, because a search is as fast as its data is small."""


class Tree(NamedTuple):
    """Nodes and leaves of the tree; node 0 is the root.

    ``boxes`` (m, 8) of nodes: the smallest and largest coordinates below, and up to which
    coordinate a point belongs to the first child. ``links`` (m, 8) of nodes: the first child, which
    the second follows, -1 in leaves; the parent, -1 for the root; the axis of the split; how many
    points are below; which leaf it is. ``members`` (l, ROOM) of leaves: their points, and again
    their coordinates in ``spots`` (l, ROOM, 3). ``homes`` (n,): the node of the leaf where a point
    is, -1 where it is not in the tree. ``used`` (2,): how many nodes and leaves there are.
    """

    boxes: Floats
    links: Numbers
    members: Numbers
    spots: Floats
    homes: Numbers
    used: Indices
    stack: Indices


@njit(cache=True)
def squared_distance(points: Floats, i: int, j: int, dimensions: int) -> float:
    """Squared distance of points i and j in their first ``dimensions`` coordinates."""
    total = 0.0
    for axis in range(dimensions):
        difference = points[i, axis] - points[j, axis]
        total += difference * difference
    return total


@njit(cache=True)
def precedes(distance: float, i: int, j: int, other: float, k: int, m: int) -> bool:
    """Whether pair (i, j) comes before pair (k, m) at distance ``other``, smaller numbers first."""
    if distance != other:
        return distance < other
    if i != k:
        return i < k
    return j < m


@njit(cache=True)
def empty_tree(capacity: int, living: int) -> Tree:
    """A tree for ``living`` points numbered below ``capacity``; fill it with `rebuild`."""
    leaves = living + 4
    nodes = 2 * leaves
    return Tree(
        np.empty((nodes, 8)),
        np.empty((nodes, 8), np.int32),
        np.empty((leaves, ROOM), np.int32),
        np.empty((leaves, ROOM, 3)),
        np.full(capacity, np.int32(-1)),
        np.zeros(2, np.int64),
        np.empty(nodes, np.int64),
    )


@njit(cache=True)
def _split(tree: Tree, node: int, axis: int, split: float) -> int:
    """Give a node two children; the number of the first."""
    boxes, links, used = tree.boxes, tree.links, tree.used
    child = int(used[0])
    used[0] += 2
    links[node, CHILD] = child
    links[node, AXIS] = axis
    boxes[node, SPLIT] = split
    for side in range(2):
        links[child + side, CHILD] = -1
        links[child + side, PARENT] = node
    return child


@njit(cache=True)
def _fill_leaf(
    tree: Tree, node: int, leaf: int, points: Floats, order: Indices, begin: int, end: int
) -> None:
    links, members, spots, homes = tree.links, tree.members, tree.spots, tree.homes
    links[node, LEAF] = leaf
    links[node, COUNT] = end - begin
    for place in range(end - begin):
        i = order[begin + place]
        members[leaf, place] = i
        homes[i] = node
        for axis in range(3):
            spots[leaf, place, axis] = points[i, axis]


@njit(cache=True)
def rebuild(tree: Tree, points: Floats, living: Indices, dimensions: int) -> None:
    """Make the tree anew of the points ``living``, whose order changes on the way."""
    boxes, links, used, stack = tree.boxes, tree.links, tree.used, tree.stack
    begins = np.empty(len(stack), np.int64)
    ends = np.empty(len(stack), np.int64)
    begins[0], ends[0] = 0, len(living)
    links[0, CHILD] = -1
    links[0, PARENT] = -1
    used[0], used[1] = 1, 0
    # One branch after another, so that what is near in space is near in memory.
    stack[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        begin, end = begins[node], ends[node]
        low = boxes[node, LOW : LOW + dimensions]
        high = boxes[node, HIGH : HIGH + dimensions]
        bound(points, living, begin, end, low, high)
        links[node, COUNT] = end - begin
        if end - begin <= FULL:
            _fill_leaf(tree, node, used[1], points, living, begin, end)
            used[1] += 1
            continue
        middle, axis, split = halve(points, living, begin, end, low, high)
        child = _split(tree, node, axis, split)
        begins[child], ends[child] = begin, middle
        begins[child + 1], ends[child + 1] = middle, end
        stack[waiting] = child + 1
        stack[waiting + 1] = child
        waiting += 2


@njit(cache=True)
def remove(tree: Tree, i: int) -> None:
    """Take point i out."""
    links, members, spots, homes = tree.links, tree.members, tree.spots, tree.homes
    node = int(homes[i])
    leaf = links[node, LEAF]
    last = links[node, COUNT] - 1
    for place in range(last):
        if members[leaf, place] == i:
            members[leaf, place] = members[leaf, last]
            for axis in range(3):
                spots[leaf, place, axis] = spots[leaf, last, axis]
            break
    homes[i] = -1
    while node >= 0:
        links[node, COUNT] -= 1
        node = int(links[node, PARENT])


@njit(cache=True)
def insert(tree: Tree, points: Floats, i: int, dimensions: int) -> bool:
    """Put point i in. False, and nothing done, where the tree has to be rebuilt first."""
    boxes, links, members, spots, homes, used = (
        tree.boxes,
        tree.links,
        tree.members,
        tree.spots,
        tree.homes,
        tree.used,
    )
    if used[0] + 2 > len(links) or used[1] + 1 > len(members):
        return False
    node = 0
    while True:
        for axis in range(dimensions):
            coordinate = points[i, axis]
            boxes[node, LOW + axis] = min(boxes[node, LOW + axis], coordinate)
            boxes[node, HIGH + axis] = max(boxes[node, HIGH + axis], coordinate)
        child = int(links[node, CHILD])
        if child < 0:
            if links[node, COUNT] < ROOM:
                break
            child = _halve_leaf(tree, points, node, dimensions)
        links[node, COUNT] += 1
        below = points[i, links[node, AXIS]] <= boxes[node, SPLIT]
        node = child if below else child + 1
    leaf = links[node, LEAF]
    place = links[node, COUNT]
    links[node, COUNT] += 1
    members[leaf, place] = i
    homes[i] = node
    for axis in range(3):
        spots[leaf, place, axis] = points[i, axis]
    return True


@njit(cache=True)
def _halve_leaf(tree: Tree, points: Floats, node: int, dimensions: int) -> int:
    """Give a full leaf two children; the number of the first."""
    leaf = tree.links[node, LEAF]
    order = tree.members[leaf].astype(np.int64)
    low, high = np.empty(dimensions), np.empty(dimensions)
    bound(points, order, 0, ROOM, low, high)
    middle, axis, split = halve(points, order, 0, ROOM, low, high)
    child = _split(tree, node, axis, split)
    for side in range(2):
        begin, end = (0, middle) if side == 0 else (middle, ROOM)
        low = tree.boxes[child + side, LOW : LOW + dimensions]
        high = tree.boxes[child + side, HIGH : HIGH + dimensions]
        bound(points, order, begin, end, low, high)
        # The first child takes over the leaf, the second gets a new one.
        _fill_leaf(
            tree, child + side, leaf if side == 0 else tree.used[1], points, order, begin, end
        )
    tree.used[1] += 1
    return child


@njit(cache=True)
def _gap(
    boxes: Floats, links: Numbers, points: Floats, i: int, node: int, dimensions: int
) -> float:
    """Squared distance of point i from a node's box; infinity where the node is empty.

    Summed as `squared_distance` does, so that rounding never makes it the larger of the two.
    """
    if links[node, COUNT] == 0:
        return np.inf
    total = 0.0
    for axis in range(dimensions):
        coordinate = points[i, axis]
        beyond = max(
            boxes[node, LOW + axis] - coordinate, coordinate - boxes[node, HIGH + axis], 0.0
        )
        total += beyond * beyond
    return total


@njit(cache=True)
def _best_of_leaf(
    members: Numbers,
    spots: Floats,
    count: int,
    points: Floats,
    i: int,
    dimensions: int,
    partner: int,
    best: float,
) -> tuple[int, float]:
    """The better of a pair (i, ``partner``) at distance ``best`` and those with a leaf's points."""
    for place in range(count):
        distance = 0.0
        for axis in range(dimensions):
            difference = spots[place, axis] - points[i, axis]
            distance += difference * difference
        j = int(members[place])
        if (
            distance <= best
            and j != i
            and precedes(distance, min(i, j), max(i, j), best, min(i, partner), max(i, partner))
        ):
            best = distance
            partner = j
    return partner, best


@njit(cache=True)
def nearest(tree: Tree, points: Floats, i: int, dimensions: int) -> tuple[int, float]:
    """The point whose pair with i comes first, and their squared distance.

    -1 and infinity where there is no other point in the tree. Point i must be in it.
    """
    # Numba counts references whenever a field is read: once is enough.
    boxes, links, members, spots, homes, _, stack = tree
    best = np.inf
    partner = -1
    # From the point's own leaf upwards: most of what is far never has to be looked at.
    climbed = int(homes[i])
    stack[0] = climbed
    waiting = 1
    while True:
        while waiting > 0:
            waiting -= 1
            node = stack[waiting]
            child = int(links[node, CHILD])
            if child >= 0:
                below = points[i, links[node, AXIS]] <= boxes[node, SPLIT]
                near = child if below else child + 1
                far = 2 * child + 1 - near
                if _gap(boxes, links, points, i, far, dimensions) <= best:
                    stack[waiting] = far
                    waiting += 1
                if _gap(boxes, links, points, i, near, dimensions) <= best:
                    stack[waiting] = near
                    waiting += 1
                continue
            partner, best = _best_of_leaf(
                members[links[node, LEAF]],
                spots[links[node, LEAF]],
                links[node, COUNT],
                points,
                i,
                dimensions,
                partner,
                best,
            )
        while True:
            parent = int(links[climbed, PARENT])
            if parent < 0:
                return partner, best
            sibling = 2 * int(links[parent, CHILD]) + 1 - climbed
            climbed = parent
            if _gap(boxes, links, points, i, sibling, dimensions) <= best:
                stack[0] = sibling
                waiting = 1
                break
