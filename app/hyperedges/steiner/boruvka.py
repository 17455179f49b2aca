"""The edges of the minimum spanning tree of many points, in nearly linear time (Numba).

Borůvka's way (March, Ram and Gray 2010 use it so): every component is linked with what is nearest
to it, found in a tree of boxes that leaves out boxes wholly within the component and those farther
away than what the component's other points have found. Links are compared by length, then by their
numbers, so that they never close a ring: the tree is the minimum spanning tree, up to rounding of
squared distances.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.nearest import precedes, squared_distance
from app.hyperedges.partition import bound, halve

FULL = 8
"""As many points a leaf has, unless they all coincide: then it has one of them."""


class Boxes(NamedTuple):
    """A tree of m boxes, the root first and parents before children, that halves a set of points.

    ``lows`` and ``highs`` (m, 3); ``children`` (m,), the first of two, or -1; ``begins`` and
    ``ends`` (m,) of the points, (n, 3), which are in the order of the boxes; ``order`` (n,) says
    which they were. ``used`` (1,): how many boxes there are.
    """

    lows: Floats
    highs: Floats
    children: Indices
    begins: Indices
    ends: Indices
    points: Floats
    order: Indices
    used: Indices


@njit(cache=True, error_model="numpy")
def spanning_edges(at: Floats, n: int) -> Indices:
    """The n - 1 edges (n - 1, 2) of the minimum spanning tree of the first n points."""
    edges = np.empty((n - 1, 2), np.int64)
    components = np.arange(n)
    boxes = _box(at, n)
    count = _link_coincident(boxes, components, edges)
    labels = np.empty(len(boxes.children), np.int64)
    partners = np.empty((n, 2), np.int64)
    squares = np.empty(n)
    stack = np.empty(len(boxes.children), np.int64)
    while count < n - 1:
        for i in range(n):
            components[i] = _component(components, i)
        _label(boxes, components, labels)
        squares[:] = np.inf
        for box in range(boxes.used[0]):
            if boxes.children[box] < 0:
                for i in range(boxes.begins[box], boxes.ends[box]):
                    _look(i, boxes, components, labels, partners, squares, stack)
        for c in range(n):
            if squares[c] < np.inf:
                count = _link(components, edges, count, partners[c, 0], partners[c, 1])
    for k in range(n - 1):
        edges[k, 0], edges[k, 1] = boxes.order[edges[k, 0]], boxes.order[edges[k, 1]]
    return edges


@njit(cache=True, error_model="numpy")
def _box(at: Floats, n: int) -> Boxes:
    boxes = Boxes(
        np.empty((2 * n, 3)),
        np.empty((2 * n, 3)),
        np.full(2 * n, -1),
        np.empty(2 * n, np.int64),
        np.empty(2 * n, np.int64),
        np.empty((n, 3)),
        np.arange(n),
        np.ones(1, np.int64),
    )
    boxes.begins[0], boxes.ends[0] = 0, n
    box = 0
    while box < boxes.used[0]:
        begin, end = boxes.begins[box], boxes.ends[box]
        low, high = boxes.lows[box], boxes.highs[box]
        bound(at, boxes.order, begin, end, low, high)
        if end - begin > FULL:
            middle, _, _ = halve(at, boxes.order, begin, end, low, high)
            if middle < end:
                child = boxes.used[0]
                boxes.used[0] += 2
                boxes.children[box] = child
                boxes.begins[child], boxes.ends[child] = begin, middle
                boxes.begins[child + 1], boxes.ends[child + 1] = middle, end
        box += 1
    for place in range(n):
        for axis in range(3):
            boxes.points[place, axis] = at[boxes.order[place], axis]
    return boxes


@njit(cache=True, error_model="numpy")
def _link_coincident(boxes: Boxes, components: Indices, edges: Indices) -> int:
    """Link leaves of many points, which coincide, and leave one in each; the number of links."""
    count = 0
    for box in range(boxes.used[0]):
        begin, end = boxes.begins[box], boxes.ends[box]
        if boxes.children[box] < 0 and end - begin > FULL:
            for i in range(begin + 1, end):
                count = _link(components, edges, count, begin, i)
            boxes.ends[box] = begin + 1
    return count


@njit(cache=True, error_model="numpy")
def _component(components: Indices, i: int) -> int:
    """The number of the component of point i; paths are halved on the way."""
    while components[i] != i:
        components[i] = components[components[i]]
        i = int(components[i])
    return i


@njit(cache=True, error_model="numpy")
def _link(components: Indices, edges: Indices, count: int, i: int, j: int) -> int:
    """Add an edge unless its ends are linked already; the number of edges."""
    a, b = _component(components, i), _component(components, j)
    if a == b:
        return count
    components[max(a, b)] = min(a, b)
    edges[count, 0], edges[count, 1] = min(i, j), max(i, j)
    return count + 1


@njit(cache=True, error_model="numpy")
def _label(boxes: Boxes, components: Indices, labels: Indices) -> None:
    """Write which component a box lies in wholly, or -1."""
    for box in range(boxes.used[0] - 1, -1, -1):
        child = boxes.children[box]
        if child >= 0:
            labels[box] = labels[child] if labels[child] == labels[child + 1] else -1
            continue
        labels[box] = components[boxes.begins[box]]
        for i in range(boxes.begins[box], boxes.ends[box]):
            if components[i] != labels[box]:
                labels[box] = -1


@njit(cache=True, error_model="numpy")
def _gap(lows: Floats, highs: Floats, box: int, points: Floats, i: int) -> float:
    """Squared distance of a point from a box, summed as `squared_distance` does."""
    total = 0.0
    for axis in range(3):
        beyond = max(lows[box, axis] - points[i, axis], points[i, axis] - highs[box, axis], 0.0)
        total += beyond * beyond
    return total


@njit(cache=True, error_model="numpy")
def _look(
    i: int,
    boxes: Boxes,
    components: Indices,
    labels: Indices,
    partners: Indices,
    squares: Floats,
    stack: Indices,
) -> None:
    """Note the point of another component nearest to i, if no other of its own found a nearer."""
    lows, highs, children, begins, ends, points, _, _ = boxes
    own = components[i]
    stack[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        box = stack[waiting]
        if labels[box] == own or _gap(lows, highs, box, points, i) > squares[own]:
            continue
        child = children[box]
        if child >= 0:
            to_one = _gap(lows, highs, child, points, i)
            near = 0 if to_one <= _gap(lows, highs, child + 1, points, i) else 1
            stack[waiting] = child + 1 - near
            stack[waiting + 1] = child + near
            waiting += 2
            continue
        for j in range(begins[box], ends[box]):
            if components[j] == own:
                continue
            square = squared_distance(points, i, j, 3)
            first, second = min(i, j), max(i, j)
            if square < squares[own] or precedes(
                square, first, second, squares[own], partners[own, 0], partners[own, 1]
            ):
                squares[own] = square
                partners[own, 0], partners[own, 1] = first, second
