"""Which boxes along the axes meet which others: a tree of boxes within boxes (Numba).

The boxes are sorted along a curve that keeps neighbours together (Morton 1966); a leaf holds `FULL`
of them in a row, and every node the box around its two children, so that the tree needs no links.
However long, flat or unequal the boxes are, it takes memory for them and for what is found only.

A box is eight numbers: the smallest x, y and z and its layer, the largest and the layer again.
Boxes of different layers do not meet.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.parallel import in_parts

FULL = 4
"""Boxes in a leaf."""

DEEPEST = 64
"""Nodes that wait while the tree is searched: one for each level and one more suffice."""

MOST_PAIRS = 1 << 60
"""More than there can be."""


class TooManyPairs(Exception):
    """More pairs of boxes meet than are to be listed."""


class Tree(NamedTuple):
    """A tree over n boxes.

    ``order`` (n,): their numbers, sorted; ``places`` (n,): where in it each is; ``boxes`` (n, 8) in
    that order. Node 1 is the root and node k has the children 2k and 2k + 1; ``nodes`` (m, 8). The
    last m/2 nodes are the leaves.
    """

    order: Indices
    places: Indices
    boxes: Floats
    nodes: Floats


def plant(boxes: Floats) -> Tree:
    """The tree over ``boxes`` (n, 8), of which there is one or more."""
    curve = _along_curve(0.5 * boxes[:, :3] + 0.5 * boxes[:, 4:7])
    layers = boxes[:, 3]
    if (layers == layers[0]).all():
        order = np.argsort(curve, kind="stable")
    else:
        order = np.lexsort((curve, layers))
    places = np.empty_like(order)
    places[order] = np.arange(len(order))
    leaves = 1
    while leaves * FULL < len(order):
        leaves *= 2
    nodes = np.repeat([np.inf, -np.inf], 4) * np.ones((2 * leaves, 1))
    boxes = boxes[order]
    _wrap(boxes, nodes)
    return Tree(order, places, boxes, nodes)


def meeting(
    tree: Tree,
    boxes: Floats,
    numbers: Indices,
    groups: tuple[Indices, Indices],
    asked: Flags | None = None,
    most: int = MOST_PAIRS,
) -> Indices:
    """Pairs (m, 2) of a box among ``numbers`` and one of the tree's that it meets, sorted.

    ``boxes`` (k, 8) are those that ``numbers`` name; ``groups`` of these (k,) and of the tree's
    (n,): no pair is of one group. Where both are the same boxes, ``asked`` (n,) says which of them
    ``numbers`` has: no pair is found twice then, and the smaller number comes first.

    Raises `TooManyPairs` where there are more than ``most``.
    """
    count = len(tree.order)
    twice = np.zeros(count, dtype=np.bool_) if asked is None else asked
    parts = in_parts(
        len(numbers),
        lambda begin, end: _collect(
            tree, boxes, numbers[begin:end], groups[0], groups[1], twice, most
        ),
    )
    if sum(map(len, parts)) > most:
        raise TooManyPairs
    found = np.concatenate(parts)
    if asked is not None:
        found.sort(axis=1)
    keys = np.sort(found[:, 0] * count + found[:, 1])
    return np.stack(np.divmod(keys, count), axis=1)


def meeting_any(tree: Tree, boxes: Floats) -> Flags:
    """Which of the ``boxes`` (k, 8) meet one of the tree's or more."""
    parts = in_parts(len(boxes), lambda begin, end: _meet_any(tree, boxes[begin:end]))
    return np.asarray(np.concatenate(parts))


def _along_curve(middles: Floats) -> Indices:
    """Each place's (n, 3) number on the Morton curve."""
    corner = middles.min(axis=0)
    cell = float((middles.max(axis=0) - corner).max()) / 2**20
    cells = ((middles - corner) / (cell if cell > 0 else 1.0)).astype(np.uint64)
    cells = np.minimum(cells, np.uint64(2**20))
    for shift, mask in _SPREADING:
        cells = (cells | (cells << np.uint64(shift))) & np.uint64(mask)
    x, y, z = cells.astype(np.int64).T
    found: Indices = 4 * x + 2 * y + z
    return found


# Each round moves the upper half of every group of bits away, until two blanks follow each bit.
_SPREADING = (
    (32, 0x1F00000000FFFF),
    (16, 0x1F0000FF0000FF),
    (8, 0x100F00F00F00F00F),
    (4, 0x10C30C30C30C30C3),
    (2, 0x1249249249249249),
)


@njit(cache=True, error_model="numpy")
def _wrap(boxes: Floats, nodes: Floats) -> None:
    leaves = len(nodes) // 2
    for i in range(len(boxes)):
        for side in range(4):
            node = leaves + i // FULL
            nodes[node, side] = min(nodes[node, side], boxes[i, side])
            nodes[node, side + 4] = max(nodes[node, side + 4], boxes[i, side + 4])
    for node in range(leaves - 1, 0, -1):
        for side in range(4):
            nodes[node, side] = min(nodes[2 * node, side], nodes[2 * node + 1, side])
            nodes[node, side + 4] = max(nodes[2 * node, side + 4], nodes[2 * node + 1, side + 4])


@njit(cache=True, error_model="numpy", inline="always")
def _meet(boxes: Floats, i: int, others: Floats, j: int) -> bool:
    return bool(
        boxes[i, 0] <= others[j, 4]
        and others[j, 0] <= boxes[i, 4]
        and boxes[i, 1] <= others[j, 5]
        and others[j, 1] <= boxes[i, 5]
        and boxes[i, 2] <= others[j, 6]
        and others[j, 2] <= boxes[i, 6]
        and boxes[i, 3] <= others[j, 7]
        and others[j, 3] <= boxes[i, 7]
    )


@njit(cache=True, error_model="numpy", nogil=True)
def _collect(
    tree: Tree,
    boxes: Floats,
    numbers: Indices,
    groups: Indices,
    tree_groups: Indices,
    asked: Flags,
    most: int,
) -> Indices:
    """At most one pair more than ``most``."""
    order, places, tree_boxes, nodes = tree
    leaves = len(nodes) // 2
    stack = np.empty(DEEPEST, np.int64)
    found = np.empty((4 * len(numbers) + 64, 2), np.int64)
    count = 0
    everyone = asked.all()
    for i in numbers:
        # Where all boxes ask, each finds only those behind it.
        begin = places[i] + 1 if everyone else 0
        waiting = 1
        stack[0] = 1
        while waiting > 0:
            waiting -= 1
            node = stack[waiting]
            if node < leaves:
                for child in (2 * node + 1, 2 * node):
                    if _meet(boxes, i, nodes, child):
                        stack[waiting] = child
                        waiting += 1
                continue
            first = (node - leaves) * FULL
            for place in range(max(first, begin), min(first + FULL, len(order))):
                j = order[place]
                if groups[i] == tree_groups[j] or (asked[j] and places[j] <= places[i]):
                    continue
                if _meet(boxes, i, tree_boxes, place):
                    if count == len(found):
                        larger = np.empty((2 * count, 2), np.int64)
                        larger[:count] = found
                        found = larger
                    found[count, 0], found[count, 1] = i, j
                    count += 1
                    if count > most:
                        return found[:count]
    return found[:count].copy()


@njit(cache=True, error_model="numpy", nogil=True)
def _meet_any(tree: Tree, boxes: Floats) -> Flags:
    _, _, tree_boxes, nodes = tree
    leaves = len(nodes) // 2
    stack = np.empty(DEEPEST, np.int64)
    found = np.zeros(len(boxes), np.bool_)
    for i in range(len(boxes)):
        waiting = 1
        stack[0] = 1
        while waiting > 0 and not found[i]:
            waiting -= 1
            node = stack[waiting]
            if node < leaves:
                for child in (2 * node + 1, 2 * node):
                    if _meet(boxes, i, nodes, child):
                        stack[waiting] = child
                        waiting += 1
                continue
            first = (node - leaves) * FULL
            for place in range(first, min(first + FULL, len(tree_boxes))):
                if _meet(boxes, i, tree_boxes, place):
                    found[i] = True
                    break
    return found
