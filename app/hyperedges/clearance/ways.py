"""The way from one piece of a hyperedge to another, along its tree (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance.pieces import Pieces
from app.hyperedges.routing import Routing


class Ways(NamedTuple):
    """The trees of all hyperedges, piece by piece, (p,) each.

    ``parents``: the next piece on the way to the hyperedge's first attachment, -1 there;
    ``depths``: how many follow; ``forks``: whether three segments or more meet between a piece and
    its parent; ``lengths``: of the pieces.
    """

    parents: Indices
    depths: Indices
    forks: NDArray[np.bool_]
    lengths: Floats


class Way(NamedTuple):
    """The way between two pieces: its length and how many pieces are on it, the two not counted.

    ``forked``: whether it passes a join of three; ``after`` is the piece that it goes to from the
    first, ``before`` the one that it comes from to the second. Where it was left halfway only the
    length counts, which is too small.
    """

    length: float
    steps: int
    forked: bool
    after: int
    before: int


def ways_of(routing: Routing, pieces: Pieces) -> Ways:
    """The trees of a routing's hyperedges, in ``pieces``."""
    counts = routing.attachment_counts + np.diff(routing.join_starts)
    firsts = np.cumsum(counts) - counts
    # What segments begin and end at, numbered through all hyperedges.
    nodes = routing.segment_ends + np.repeat(firsts, np.diff(routing.segment_starts))[:, None]
    parents, depths, gates = _rooted(routing.segment_starts, nodes, pieces.starts)
    forks = (np.bincount(nodes.ravel()) > 2)[gates] & (gates >= 0)
    return Ways(parents, depths, forks, pieces.lengths)


@njit(cache=True, error_model="numpy")
def walk(a: int, b: int, ways: Ways, limit: float) -> Way:
    """The way from piece ``a`` to another one ``b``, left once it is longer than ``limit``."""
    parents, depths, forks, lengths = ways
    first, second = a, b
    length, steps, forked = 0.0, 0, False
    while not (
        parents[first] == parents[second] or parents[first] == second or parents[second] == first
    ):
        steps += 1
        if depths[first] >= depths[second]:
            forked |= forks[first]
            first = parents[first]
            length += lengths[first]
        else:
            forked |= forks[second]
            second = parents[second]
            length += lengths[second]
        if length > limit:
            break
    # Two with one parent are both behind the same join, a child is behind the one before it.
    forked |= forks[second if parents[second] == first else first]
    after = parents[a] if first != a else second
    before = parents[b] if second != b else first
    return Way(length, steps, forked, after, before)


@njit(cache=True, error_model="numpy")
def _rooted(
    segment_starts: Indices, nodes: Indices, pieces: Indices
) -> tuple[Indices, Indices, Indices]:
    """Parents and depths of pieces, and the nodes between them and their parents, (p,) each.

    Segment s has the pieces ``pieces[s]`` to ``pieces[s + 1]`` and runs from node to node of
    ``nodes`` (s, 2); between pieces of one segment there is none, -1.
    """
    parents = np.full(pieces[-1], -1)
    depths = np.zeros(pieces[-1], np.int64)
    gates = np.full(pieces[-1], -1)
    count = nodes.max() + 1
    # The segment ends at each node: 2 s + which end.
    starts = np.zeros(count + 1, np.int64)
    for s in range(len(nodes)):
        for end in range(2):
            starts[nodes[s, end] + 1] += 1
    starts = np.cumsum(starts)
    filled = starts[:-1].copy()
    members = np.empty(2 * len(nodes), np.int64)
    for s in range(len(nodes)):
        for end in range(2):
            members[filled[nodes[s, end]]] = 2 * s + end
            filled[nodes[s, end]] += 1
    seen = np.zeros(len(nodes), np.bool_)
    arrivals = np.full(count, -1)
    queue = np.empty(count, np.int64)
    for k in range(len(segment_starts) - 1):
        if segment_starts[k] == segment_starts[k + 1]:
            continue
        first = nodes[segment_starts[k], 0]
        for s in range(segment_starts[k], segment_starts[k + 1]):
            first = min(first, nodes[s, 0], nodes[s, 1])
        queue[0] = first
        taken, known = 0, 1
        while taken < known:
            node = queue[taken]
            taken += 1
            for member in members[starts[node] : starts[node + 1]]:
                s, end = member // 2, member % 2
                if seen[s]:
                    continue
                seen[s] = True
                before = arrivals[node]
                for step in range(pieces[s + 1] - pieces[s]):
                    piece = pieces[s] + step if end == 0 else pieces[s + 1] - 1 - step
                    parents[piece] = before
                    if step == 0:
                        gates[piece] = node
                    depths[piece] = 0 if before < 0 else depths[before] + 1
                    before = piece
                other = nodes[s, 1 - end]
                if other != first and arrivals[other] < 0:
                    arrivals[other] = before
                    queue[known] = other
                    known += 1
    return parents, depths, gates
