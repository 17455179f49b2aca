"""The star expansion of a hypergraph: its items, and a centre for each hyperedge, as one graph."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of

SPOKE = 1.8
"""Ideal length from the rim of an item to the centre of its hyperedge, document units."""

GROWTH = 0.15
"""How much longer that is, over the square root of the number of the item's hyperedges."""


@dataclass(frozen=True, slots=True, eq=False)
class Star:
    """A graph of n items and h hyperedges' centres behind them; both ways of m spokes.

    The neighbours of node v are ``neighbours[starts[v] : starts[v + 1]]`` (2 m,), as far from it
    as ``lengths`` (2 m,) say, document units; ``starts`` (n + h + 1,).
    """

    starts: Indices
    neighbours: Indices
    lengths: Floats


def star_of(radii: Floats, starts: Indices, members: Indices, spacing: float = 1.0) -> Star:
    """The star expansion for items of so large ``radii`` (n,).

    The items of hyperedge k are ``members[starts[k] : starts[k + 1]]``, each of them once. Ways
    between them are ``spacing`` times as long as usual.
    """
    items = len(radii)
    degrees = np.bincount(members, minlength=items)
    owners = items + np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    lengths = radii[members] + spacing * SPOKE * (1.0 + GROWTH * np.sqrt(degrees[members]))
    first, second = np.concatenate([owners, members]), np.concatenate([members, owners])
    order = np.lexsort((second, first))
    counts = np.bincount(first, minlength=items + len(starts) - 1)
    return Star(np.concatenate([[0], np.cumsum(counts)]), second[order], np.tile(lengths, 2)[order])


def components_of(star: Star) -> list[Indices]:
    """The nodes of each connected component, ascending; components by their first nodes."""
    labels = np.asarray(_labels(star.starts, star.neighbours))
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(labels[order])) + 1) if len(order) else []


def part_of(star: Star, nodes: Indices) -> Star:
    """The graph of a component's ``nodes`` (k,) alone, ascending, numbered from 0."""
    numbers = np.empty(len(star.starts) - 1, dtype=np.int64)
    numbers[nodes] = np.arange(len(nodes))
    counts = np.diff(star.starts)[nodes]
    rows = rows_of(star.starts, nodes)
    return Star(starts_of(counts), numbers[star.neighbours[rows]], star.lengths[rows])


@njit(cache=True, error_model="numpy")
def _labels(starts: Indices, neighbours: Indices) -> Indices:
    count = len(starts) - 1
    labels = np.full(count, -1)
    waiting = np.empty(count, dtype=np.int64)
    found = 0
    for node in range(count):
        if labels[node] >= 0:
            continue
        labels[node] = found
        waiting[0] = node
        first, end = 0, 1
        while first < end:
            here = waiting[first]
            first += 1
            for row in range(starts[here], starts[here + 1]):
                there = neighbours[row]
                if labels[there] < 0:
                    labels[there] = found
                    waiting[end] = there
                    end += 1
        found += 1
    return labels


@njit(cache=True, error_model="numpy")
def distances_from(
    starts: Indices, neighbours: Indices, lengths: Floats, sources: Indices
) -> Floats:
    """Distances (s, v) of all nodes from ``sources`` (s,): of the shortest way of fewest spokes.

    Infinite where there is no way.
    """
    count = len(starts) - 1
    found = np.full((len(sources), count), np.inf)
    hops = np.empty(count, dtype=np.int64)
    waiting = np.empty(count, dtype=np.int64)
    for row, source in enumerate(sources):
        hops[:] = -1
        hops[source] = 0
        found[row, source] = 0.0
        waiting[0] = source
        first, end = 0, 1
        while first < end:
            here = waiting[first]
            first += 1
            for spoke in range(starts[here], starts[here + 1]):
                there = neighbours[spoke]
                length = found[row, here] + lengths[spoke]
                if hops[there] < 0:
                    hops[there] = hops[here] + 1
                    found[row, there] = length
                    waiting[end] = there
                    end += 1
                elif hops[there] == hops[here] + 1 and length < found[row, there]:
                    found[row, there] = length
    return found
