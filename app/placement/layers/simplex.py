"""Network simplex: whole numbers that keep distances and make weighted distances least (Numba).

As in Gansner, Koutsofios, North and Vo, "A Technique for Drawing Directed Graphs" (1993). Only
whole numbers are computed with, so that every machine finds the same solution.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Indices

UNREACHED = -1


def solve(
    count: int,
    tails: Indices,
    heads: Indices,
    lengths: Indices,
    weights: Indices,
    work: int,
    start: Indices | None = None,
) -> Indices:
    """Whole numbers y (count,), from 0 on, with the least sum of weights · (y[head] - y[tail]).

    y[head] - y[tail] is at least ``lengths`` (e,). The edges must join all nodes, and have no
    cycle that is longer than 0. After ``work`` looks at edges it ends with the best so far. It
    begins at ``start`` (count,), numbers that keep all distances. Raises `ValueError` where there
    is no solution.
    """
    if count == 0:
        return np.zeros(0, dtype=np.int64)
    tails, heads, lengths = (
        np.ascontiguousarray(each, dtype=np.int64) for each in (tails, heads, lengths)
    )
    values = _longest_paths(count, tails, heads, lengths) if start is None else start.copy()
    if start is None and values[0] < 0:
        raise ValueError("edges go round in a circle")
    tree = _tight_tree(count, tails, heads, lengths, values)
    if tree.min(initial=0) < 0:
        raise ValueError("edges do not join all nodes")
    pull = np.zeros(count, dtype=np.int64)
    np.add.at(pull, heads, weights)
    np.subtract.at(pull, tails, weights)
    _improve(values, tree, pull, tails, heads, lengths, work)
    return np.asarray(values - values.min())


@njit(cache=True)
def _longest_paths(count: int, tails: Indices, heads: Indices, lengths: Indices) -> Indices:
    """The least values that keep all distances, all at least 0; -1 where there are none."""
    starts = np.zeros(count + 1, np.int64)
    waits = np.zeros(count, np.int64)
    for e in range(len(tails)):
        starts[tails[e] + 1] += 1
        waits[heads[e]] += 1
    starts = np.cumsum(starts)
    places = starts[:-1].copy()
    out = np.empty(len(tails), np.int64)
    for e in range(len(tails)):
        out[places[tails[e]]] = e
        places[tails[e]] += 1
    values = np.zeros(count, np.int64)
    ready = np.empty(count, np.int64)
    last = 0
    for node in range(count):
        if waits[node] == 0:
            ready[last] = node
            last += 1
    first = 0
    while first < last:
        node = ready[first]
        first += 1
        for place in range(starts[node], starts[node + 1]):
            e = out[place]
            head = heads[e]
            values[head] = max(values[head], values[node] + lengths[e])
            waits[head] -= 1
            if waits[head] == 0:
                ready[last] = head
                last += 1
    if last < count:
        values[0] = -1
    return values


@njit(cache=True)
def _tight_tree(
    count: int, tails: Indices, heads: Indices, lengths: Indices, values: Indices
) -> Indices:
    """Edges (count - 1,) of a tree without slack; moves ``values`` for it. -1 where it misses some.

    The tree grows from node 0; what is not joined to it without slack moves nearer as one.
    """
    tree = np.full(count - 1, UNREACHED, np.int64)
    inside = np.zeros(count, np.bool_)
    inside[0] = True
    size = 1
    while size < count:
        grown = True
        while grown:
            grown = False
            for e in range(len(tails)):
                u, v = tails[e], heads[e]
                if inside[u] != inside[v] and values[v] - values[u] == lengths[e]:
                    tree[size - 1] = e
                    inside[u] = inside[v] = True
                    size += 1
                    grown = True
        if size == count:
            break
        nearest, least = UNREACHED, 0
        for e in range(len(tails)):
            if inside[tails[e]] != inside[heads[e]]:
                slack = values[heads[e]] - values[tails[e]] - lengths[e]
                if nearest == UNREACHED or slack < least:
                    nearest, least = e, slack
        if nearest == UNREACHED:
            break
        shift = least if inside[tails[nearest]] else -least
        for node in range(count):
            if inside[node]:
                values[node] += shift
    return tree


@njit(cache=True)
def _hang(
    count: int, tree: Indices, tails: Indices, heads: Indices, parents: Indices, order: Indices,
    ends: Indices,
) -> None:  # fmt: skip
    """Hang the tree from node 0: each node's tree edge (place in ``tree``), preorder, subtrees.

    The subtree of ``order[i]`` is ``order[i]`` to ``order[ends[i] - 1]``.
    """
    starts = np.zeros(count + 1, np.int64)
    for e in tree:
        starts[tails[e] + 1] += 1
        starts[heads[e] + 1] += 1
    starts = np.cumsum(starts)
    places = starts[:-1].copy()
    around = np.empty(2 * len(tree), np.int64)
    for k in range(len(tree)):
        e = tree[k]
        around[places[tails[e]]] = k
        places[tails[e]] += 1
        around[places[heads[e]]] = k
        places[heads[e]] += 1
    stack = np.empty(count, np.int64)
    sizes = np.ones(count, np.int64)
    stack[0] = 0
    parents[0] = UNREACHED
    depth, number = 1, 0
    while depth:
        depth -= 1
        node = stack[depth]
        order[number] = node
        number += 1
        for place in range(starts[node], starts[node + 1]):
            k = around[place]
            if k == parents[node]:
                continue
            e = tree[k]
            other = heads[e] if tails[e] == node else tails[e]
            parents[other] = k
            stack[depth] = other
            depth += 1
    for i in range(count - 1, 0, -1):
        node = order[i]
        e = tree[parents[node]]
        sizes[heads[e] if tails[e] == node else tails[e]] += sizes[node]
    for i in range(count):
        ends[i] = i + sizes[order[i]]


@njit(cache=True)
def _improve(
    values: Indices, tree: Indices, pull: Indices, tails: Indices, heads: Indices,
    lengths: Indices, work: int,
) -> None:  # fmt: skip
    """Exchange tree edges until no subtree gains by moving: the values are best then."""
    count = len(values)
    parents = np.empty(count, np.int64)
    order = np.empty(count, np.int64)
    ends = np.empty(count, np.int64)
    places = np.empty(count, np.int64)
    pulls = np.empty(count, np.int64)
    done = 0
    while done < work:
        done += count + len(tails)
        _hang(count, tree, tails, heads, parents, order, ends)
        for i in range(count):
            places[order[i]] = i
        pulls[:] = pull
        best, gain = UNREACHED, 0
        for i in range(count - 1, 0, -1):
            node = order[i]
            e = tree[parents[node]]
            is_head = heads[e] == node
            pulls[tails[e] if is_head else heads[e]] += pulls[node]
            # Moving the subtree away from its tree edge lessens the sum by this.
            gained = -pulls[node] if is_head else pulls[node]
            if gained > gain:
                best, gain = i, gained
        if best == UNREACHED:
            return
        first, end = best, ends[best]
        leaving = parents[order[best]]
        upwards = heads[tree[leaving]] == order[best]
        entering, least = UNREACHED, 0
        for e in range(len(tails)):
            from_inside = first <= places[tails[e]] < end
            to_inside = first <= places[heads[e]] < end
            if from_inside == to_inside or from_inside != upwards:
                continue
            slack = values[heads[e]] - values[tails[e]] - lengths[e]
            if entering == UNREACHED or slack < least:
                entering, least = e, slack
        if entering == UNREACHED:
            return
        for i in range(first, end):
            values[order[i]] += least if upwards else -least
        tree[leaving] = entering
