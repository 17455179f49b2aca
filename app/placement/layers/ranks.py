"""The rank of every item: nets go from left to right, as short as they can be."""

from __future__ import annotations

import numpy as np

from app.arrays import Flags, Indices
from app.placement.layers.graph import Graph
from app.placement.layers.simplex import solve

FEEDBACK = 5
"""Weight of a net that goes back, in hundredths: short too, but softly."""

FROM_STATE = 1.3
"""Weight of what an item with a state drives, over that of others: it stands near that."""

ROUNDS = 50
"""In which one node of each component at a time keeps what leads into it."""

WORK = 1_000_000_000
"""Looks at edges until the ranks are good enough."""


def ranks(graph: Graph) -> Indices:
    """Ranks (n,) of the items of a connected graph, from 0 on."""
    tails, heads, nets, is_hard = graph.edges
    # Those that share the last rank are one node here.
    last = np.flatnonzero(graph.is_last)
    nodes = np.arange(len(graph.halves))
    if len(last):
        nodes[last] = last[0]
    used, nodes = np.unique(nodes, return_inverse=True)
    is_state = graph.is_state[used]
    weights = graph.weights[nets] * np.where(graph.is_state[tails], FROM_STATE, 1.0)
    tails, heads = nodes[tails], nodes[heads]
    keep = tails != heads
    tails, heads, weights, hard = tails[keep], heads[keep], weights[keep], is_hard[keep]
    forth = hard.copy()
    forth[hard] = ~feedback(len(used), tails[hard], heads[hard], is_state)
    back = ~forth
    # |y[head] - y[tail]| of feedback, and of ends that both give: a node of its own below both.
    between = len(used) + np.arange(np.count_nonzero(back))
    soft = np.full(2 * len(between), FEEDBACK)
    found = solve(
        len(used) + len(between),
        np.concatenate([tails[forth], between, between]),
        np.concatenate([heads[forth], tails[back], heads[back]]),
        np.concatenate([np.ones(np.count_nonzero(forth), dtype=np.int64), 0 * soft]),
        np.concatenate([np.rint(weights[forth]).astype(np.int64), soft]),
        WORK,
    )
    found = found[: len(used)]
    return np.asarray((found - found.min(initial=0))[nodes])


def feedback(count: int, tails: Indices, heads: Indices, is_state: Flags) -> Flags:
    """Which edges (e,) go back, so that the others have no cycle.

    Within strongly connected components these are the edges out of items with a state; where cycles
    remain, those into the node with the most edges out more than in; after some rounds of that all
    that lead back in the order of these numbers.
    """
    back = np.zeros(len(tails), dtype=np.bool_)
    is_first = True
    for _ in range(ROUNDS):
        rows = np.flatnonzero(~back)
        parts = _strong_parts(count, tails[rows], heads[rows])
        cyclic = rows[parts[tails[rows]] == parts[heads[rows]]]
        if not len(cyclic):
            return back
        states = cyclic[is_state[tails[cyclic]]] if is_first else cyclic[:0]
        is_first = False
        if len(states):
            back[states] = True
            continue
        # One node of each component at a time.
        more = np.bincount(tails[cyclic], minlength=count) - np.bincount(
            heads[cyclic], minlength=count
        )
        inner = np.unique(tails[cyclic])
        order = inner[np.lexsort((inner, -more[inner], parts[inner]))]
        firsts = order[np.unique(parts[order], return_index=True)[1]]
        back[cyclic[np.isin(heads[cyclic], firsts)]] = True
    rest = np.flatnonzero(~back)
    more = np.bincount(tails[rest], minlength=count) - np.bincount(heads[rest], minlength=count)
    place = np.empty(count, dtype=np.int64)
    place[np.lexsort((np.arange(count), -more))] = np.arange(count)
    parts = _strong_parts(count, tails[rest], heads[rest])
    in_one = parts[tails[rest]] == parts[heads[rest]]
    back[rest[in_one & (place[tails[rest]] > place[heads[rest]])]] = True
    return back


def _strong_parts(count: int, tails: Indices, heads: Indices) -> Indices:
    # Not what every process needs.
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    matrix = coo_array((np.ones(len(tails)), (tails, heads)), shape=(count, count))
    _, parts = connected_components(matrix, directed=True, connection="strong")
    return np.asarray(parts, dtype=np.int64)
