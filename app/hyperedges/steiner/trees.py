"""Short trees of all hyperedges of a program.

The minimum spanning tree is made into a tree of joins, one attachment after another, and that is
improved by small changes; then the joins are put where the tree is shortest. This finds the
shortest tree of most hyperedges of up to eight attachments, and is never longer than the minimum
spanning tree.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import frexp, ldexp

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.exchanges import improve
from app.hyperedges.steiner.growth import grow
from app.hyperedges.steiner.numbering import list_edges, number_joins
from app.hyperedges.steiner.relaxation import COARSE, FINE, relax, snap, walk
from app.hyperedges.steiner.spanning import span

ROUNDED, NEARLY_SHARP, SHARP = 1e-2, 1e-3, 1e-10
"""ε for relaxation, in mean lengths of an edge: at first, before changes, and in the end."""


@dataclass(frozen=True, slots=True, eq=False)
class Trees:
    """Trees of h hyperedges, each of N attachments and N - 2 joins.

    ``joins`` (j, d), document units; those of hyperedge k from ``join_starts[k]`` to
    ``join_starts[k + 1]`` (h + 1,). ``edges`` (e, 2), likewise by ``edge_starts`` (h + 1,): what is
    joined to what, numbered within the hyperedge: 0 to N - 1 are its attachments, N to 2N - 3 its
    joins. Every attachment has one edge and every join three; some may have no length, where the
    best place of a join is that of an attachment or of another join.

    Joins are numbered along a walk from attachment 0 that takes first, at each join, the branch
    with the smallest attachment. Edge i < N is that of attachment i, (i, its join); the others are
    (smaller join, larger join), by the larger. Two attachments have the edge (0, 1).
    """

    joins: Floats
    join_starts: Indices
    edges: Indices
    edge_starts: Indices


def short_trees(points: Floats, starts: Indices) -> Trees:
    """Trees that join the ``points`` (a, 2) or (a, 3) of each hyperedge by a short way.

    Those of hyperedge k are ``starts[k]`` to ``starts[k + 1]`` (h + 1,), two or more each.

    Raises `ValueError` where a hyperedge has fewer than two attachments.

    >>> corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    >>> trees = short_trees(corners, np.array([0, 4]))
    >>> trees.edges.tolist()
    [[0, 4], [1, 4], [2, 5], [3, 5], [4, 5]]
    >>> trees.joins.round(3).tolist()
    [[0.5, 0.289], [0.5, 0.711]]
    """
    counts = np.diff(starts)
    if len(counts) and int(counts.min()) < 2:
        raise ValueError("A hyperedge has two or more attachments.")
    hyperedges = np.arange(len(starts))
    join_starts = starts - 2 * hyperedges
    edge_starts = 2 * starts - 3 * hyperedges
    joins = np.zeros((join_starts[-1], points.shape[1]))
    edges = np.zeros((edge_starts[-1], 2), dtype=np.int64)
    if len(counts):
        _join_all(
            np.ascontiguousarray(points, dtype=np.float64),
            np.ascontiguousarray(starts, dtype=np.int64),
            int(counts.max()),
            joins,
            edges,
        )
    return Trees(joins, join_starts, edges, edge_starts)


@njit(cache=True, error_model="numpy")
def _join_all(points: Floats, starts: Indices, most: int, joins: Floats, edges: Indices) -> None:
    at = np.zeros((2 * most, 3))
    arms = np.empty((2 * most, 3), np.int64)
    names = np.empty(most, np.int64)
    order = np.empty(most, np.int64)
    parents = np.empty(2 * most, np.int64)
    origin = np.zeros(3)
    for k in range(len(starts) - 1):
        begin = starts[k]
        n = starts[k + 1] - begin
        row, edge = begin - 2 * k, 2 * begin - 3 * k
        if n == 2:
            edges[edge, 0], edges[edge, 1] = 0, 1
            continue
        exponent = _scale(points[begin : begin + n], at, origin)
        length = span(at, n, names, parents)
        grow(at, arms, n, parents)
        walk(arms, n, order, parents)
        if n > 3 and length > 0.0:
            unit = length / n
            relax(at, arms, n, order, parents, ROUNDED * unit, NEARLY_SHARP * unit, COARSE)
            improve(at, arms, n)
            walk(arms, n, order, parents)
            relax(at, arms, n, order, parents, ROUNDED * unit, SHARP * unit, FINE)
            snap(at, arms, n)
        # The walk began at names[0], which is attachment 0.
        listed = joins[row : row + n - 2]
        numbers = np.empty(n - 2, np.int64)
        number_joins(arms, n, order, parents, names, numbers)
        list_edges(arms, n, parents, names, numbers, edges[edge : edge + 2 * n - 3])
        for place in range(n - 2):
            for axis in range(points.shape[1]):
                listed[place, axis] = ldexp(at[numbers[place], axis] + origin[axis], exponent)


@njit(cache=True, error_model="numpy")
def _scale(points: Floats, at: Floats, origin: Floats) -> int:
    """Write points divided by a power of two, less ``origin``, so that they are about one apart.

    Returns the power's exponent. Nothing is lost, so that a join on an attachment stays there.
    """
    extent = 0.0
    for axis in range(points.shape[1]):
        for i in range(len(points)):
            extent = max(extent, abs(points[i, axis] - points[0, axis]))
    exponent = frexp(extent)[1]
    for axis in range(points.shape[1]):
        whole = np.rint(ldexp(points[0, axis], -exponent))
        # Whole numbers nearer to zero would cost the smallest coordinates their last digits.
        origin[axis] = whole if abs(whole) >= 4.0 else 0.0
        for i in range(len(points)):
            at[i, axis] = ldexp(points[i, axis], -exponent) - origin[axis]
    return exponent
