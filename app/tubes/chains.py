"""Rings of segments that pass into each other at joins, as rings of one longer tube.

Of the segments of a join, one that comes to it and one that leaves it along the join's tangent are
one tube, for they share the ring there. So a hyperedge of N attachments is N - 1 chains instead of
2(N - 2) + 1 segments, and that many fewer bodies have to be united.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats, Indices, Singles
from app.hyperedges.routing import Routing
from app.tubes.sweep import stack_tubes
from app.tubes.tessellation import Tessellation

_NONE = -1


@dataclass(frozen=True, slots=True, eq=False)
class Rings:
    """The rings of c chains, without rounded ends.

    ``vertices`` (v, 3) float64 and unit ``radials`` (v, 3), which point away from the curve. Ring
    j of chain k begins at vertex ``starts[k] + j * sides[k]`` (``starts`` is (c + 1,)); there are
    ``counts[k]`` of them, of ``radii[k]``, each in the sense of rotation of the chain's course.
    Chains of hyperedge i are ``chain_starts[i]`` to ``chain_starts[i + 1]`` (h + 1,).
    """

    vertices: Floats
    radials: Floats
    starts: Indices
    sides: Indices
    counts: Indices
    radii: Floats
    chain_starts: Indices


def chain_rings(routing: Routing, plan: Tessellation) -> Rings:
    """The rings of all segments, in chains."""
    stacks, vertices, radials, _ = stack_tubes(routing, plan, np.zeros_like(plan.ends.free))
    links = _link(
        routing.segment_starts,
        routing.segment_ends,
        routing.attachment_counts,
        np.diff(routing.join_starts),
        plan.ends.senses,
    )
    order, chains = _walk(links)
    counts = plan.rings.counts
    shared = np.bincount(chains) - 1
    lengths = np.bincount(chains, counts[order >> 1]).astype(np.int64) - shared
    _, heads = np.unique(chains, return_index=True)
    sides = plan.sides[order[heads] >> 1]
    starts = np.concatenate([[0], np.cumsum(lengths * sides)])
    places, spokes = np.empty((starts[-1], 3)), np.empty((starts[-1], 3))
    _thread(
        vertices, radials, stacks.vertices, counts, order, chains, starts, sides, places, spokes
    )
    owners = plan.hyperedges[order[heads] >> 1]
    return Rings(
        places,
        spokes,
        starts,
        sides,
        lengths,
        routing.radii[owners],
        np.searchsorted(owners, np.arange(len(routing.radii) + 1)),
    )


@njit(cache=True, error_model="numpy")
def _link(
    segment_starts: Indices,
    segment_ends: Indices,
    attachment_counts: Indices,
    join_counts: Indices,
    senses: Floats,
) -> Indices:
    """What each segment's end goes on as (s, 2): twice a segment plus its end, or -1."""
    links = np.full(segment_ends.shape, _NONE)
    for h in range(len(attachment_counts)):
        # At each join the first end that the tangent enters by, and the first that it leaves by.
        firsts = np.full((join_counts[h], 2), _NONE)
        for s in range(segment_starts[h], segment_starts[h + 1]):
            for end in range(2):
                join = segment_ends[s, end] - attachment_counts[h]
                if join >= 0:
                    leaves = (senses[s, end] > 0.0) == (end == 0)
                    if firsts[join, int(leaves)] == _NONE:
                        firsts[join, int(leaves)] = 2 * s + end
        for join in range(len(firsts)):
            one, other = firsts[join, 0], firsts[join, 1]
            if min(one, other) != _NONE:
                links[one // 2, one % 2] = other
                links[other // 2, other % 2] = one
    return links


@njit(cache=True, error_model="numpy")
def _walk(links: Indices) -> tuple[Indices, Indices]:
    """All segments chain by chain (s,), and their chains' numbers (s,).

    Each as twice its number, plus one where its chain runs through it from its last end.
    """
    count = len(links)
    order, chains = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    seen = np.zeros(count, dtype=np.bool_)
    found, chain = 0, 0
    for s in range(count):
        for end in range(2):
            if seen[s] or links[s, end] != _NONE:
                continue
            at = 2 * s + end
            while at != _NONE:
                order[found], chains[found] = at, chain
                seen[at // 2] = True
                found += 1
                at = links[at // 2, 1 - at % 2]
            chain += 1
    return order, chains


@njit(cache=True, error_model="numpy")
def _thread(
    vertices: Singles,
    radials: Singles,
    vertex_starts: Indices,
    counts: Indices,
    order: Indices,
    chains: Indices,
    starts: Indices,
    sides: Indices,
    places: Floats,
    spokes: Floats,
) -> None:
    """Fill ``places`` and ``spokes`` with the rings of segments in ``order``."""
    at = 0
    for k in range(len(order)):
        s, backwards = order[k] // 2, order[k] % 2
        n, count = sides[chains[k]], counts[s]
        first, turned, step = 0, 0, 1
        if backwards:
            step = -1
        if k == 0 or chains[k] != chains[k - 1]:
            at = starts[chains[k]]
        else:
            first = 1
            ring = vertex_starts[s] + backwards * (count - 1) * n
            turned = _nearest(vertices, ring, n, places, at - n)
        for i in range(first, count):
            ring = vertex_starts[s] + n * (count - 1 - i if backwards else i)
            for k_side in range(n):
                v = ring + (turned + step * k_side) % n
                for axis in range(3):
                    places[at, axis], spokes[at, axis] = vertices[v, axis], radials[v, axis]
                at += 1


@njit(cache=True, error_model="numpy")
def _nearest(vertices: Singles, ring: int, n: int, places: Floats, at: int) -> int:
    """Which vertex of a ring is where the last ring's first one is."""
    best, least = 0, np.inf
    for k in range(n):
        apart = 0.0
        for axis in range(3):
            apart += (vertices[ring + k, axis] - places[at, axis]) ** 2
        if apart < least:
            best, least = k, apart
    return best
