"""Network simplex: whole numbers that keep distances and make weighted distances least (Numba).

As in Gansner, Koutsofios, North and Vo, "A Technique for Drawing Directed Graphs" (1993). Only
whole numbers are computed with, so that every machine finds the same solution.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Indices
from app.placement.layers.feasible import UNREACHED, incident, longest_paths, tight_tree

MOST_AT_ONCE = 256
"""Subtrees that move between two looks at the whole tree."""


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
    values = longest_paths(count, tails, heads, lengths) if start is None else start.copy()
    if start is None and values[0] < 0:
        raise ValueError("edges go round in a circle")
    tree = tight_tree(count, tails, heads, lengths, values)
    if tree.min(initial=0) < 0:
        raise ValueError("edges do not join all nodes")
    pull = np.zeros(count, dtype=np.int64)
    np.add.at(pull, heads, weights)
    np.subtract.at(pull, tails, weights)
    _improve(values, tree, pull, tails, heads, lengths, work)
    return np.asarray(values - values.min())


@njit(cache=True)
def _hang(
    count: int, tree: Indices, tails: Indices, heads: Indices, parents: Indices, order: Indices,
    ends: Indices,
) -> None:  # fmt: skip
    """Hang the tree from node 0: each node's tree edge (place in ``tree``), preorder, subtrees.

    The subtree of ``order[i]`` is ``order[i]`` to ``order[ends[i] - 1]``.
    """
    starts, around = incident(count, tails[tree], heads[tree])
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
    """Exchange tree edges until no subtree gains by moving: the values are best then.

    Subtrees that have nothing to do with each other move between two looks at the whole tree.
    """
    count = len(values)
    parents = np.empty(count, np.int64)
    order = np.empty(count, np.int64)
    ends = np.empty(count, np.int64)
    places = np.empty(count, np.int64)
    pulls = np.empty(count, np.int64)
    gains = np.empty(count, np.int64)
    touched = np.empty((MOST_AT_ONCE, 3), np.int64)
    starts, around = incident(count, tails, heads)
    done = 0
    while done < work:
        done += count + len(tails)
        _hang(count, tree, tails, heads, parents, order, ends)
        for i in range(count):
            places[order[i]] = i
        pulls[:] = pull
        gains[0] = 0
        for i in range(count - 1, 0, -1):
            node = order[i]
            e = tree[parents[node]]
            is_head = heads[e] == node
            pulls[tails[e] if is_head else heads[e]] += pulls[node]
            # Moving the subtree away from its tree edge lessens the sum by this.
            gains[i] = -pulls[node] if is_head else pulls[node]
        chosen = np.flatnonzero(gains > 0)
        if len(chosen) == 0:
            return
        chosen = chosen[np.argsort(-gains[chosen], kind="mergesort")]
        moved = 0
        for place in range(len(chosen)):
            first = int(chosen[place])
            if moved == MOST_AT_ONCE:
                break
            end = int(ends[first])
            is_free = True
            for k in range(moved):
                meets = first < touched[k, 1] and touched[k, 0] < end
                is_free = is_free and not meets and not first <= touched[k, 2] < end
            if not is_free:
                continue
            leaving = parents[order[first]]
            upwards = heads[tree[leaving]] == order[first]
            entering = _entering(
                first, end, upwards, order, places, starts, around, tails, heads, lengths, values
            )
            if entering == UNREACHED:
                continue
            u, v = tails[entering], heads[entering]
            slack = values[v] - values[u] - lengths[entering]
            for i in range(first, end):
                values[order[i]] += slack if upwards else -slack
            tree[leaving] = entering
            touched[moved] = first, end, places[v] if upwards else places[u]
            moved += 1
        if moved == 0:
            return


@njit(cache=True)
def _entering(
    first: int, end: int, upwards: bool, order: Indices, places: Indices, starts: Indices,
    around: Indices, tails: Indices, heads: Indices, lengths: Indices, values: Indices,
) -> int:  # fmt: skip
    """The edge that a subtree comes up against first where it moves, the lowest of such; or -1."""
    found, least = UNREACHED, 0
    for i in range(first, end):
        node = order[i]
        for place in range(starts[node], starts[node + 1]):
            e = around[place]
            if (tails[e] == node) != upwards:
                continue
            other = heads[e] if upwards else tails[e]
            if first <= places[other] < end:
                continue
            slack = values[heads[e]] - values[tails[e]] - lengths[e]
            if found == UNREACHED or slack < least or (slack == least and e < found):
                found, least = e, slack
    return found
