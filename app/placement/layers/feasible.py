"""Where network simplex begins: numbers that keep all distances, and a tight tree (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Indices

UNREACHED = -1


@njit(cache=True)
def incident(count: int, tails: Indices, heads: Indices) -> tuple[Indices, Indices]:
    """The edges of each node: those of node k are ``[starts[k]:starts[k + 1]]``."""
    starts = np.zeros(count + 1, np.int64)
    for e in range(len(tails)):
        starts[tails[e] + 1] += 1
        starts[heads[e] + 1] += 1
    starts = np.cumsum(starts)
    places = starts[:-1].copy()
    around = np.empty(2 * len(tails), np.int64)
    for e in range(len(tails)):
        around[places[tails[e]]] = e
        places[tails[e]] += 1
        around[places[heads[e]]] = e
        places[heads[e]] += 1
    return starts, around


@njit(cache=True)
def longest_paths(count: int, tails: Indices, heads: Indices, lengths: Indices) -> Indices:
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
def tight_tree(
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
