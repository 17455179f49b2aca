"""Places for the nodes of a hypergraph, and on each node one place for every edge that it is in.

Two tubes that end at one point touch, so each gets a point of its own, and room around it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices

PITCH = 0.45
"""Between places on one node: tubes of radius 0.08 with a clearance of 0.05 can pass between."""

INSET = 0.27
"""Of places from the rim of their node."""

LEAST_DEPTH = 0.7
GAP = 0.8
ROW_GAP = 1.1
"""Between rows: a node's label is on its front, and must not be hidden by the node before it."""

ASPECT = 1.3
"""Width over depth that the whole aims at."""

ROUNDS = 80
"""Of the power method: rows need no exact eigenvectors."""


@dataclass(frozen=True, slots=True, eq=False)
class Arrangement:
    """n nodes and their m places, seen from above, in document units.

    ``centers`` (n, 2); ``sizes`` (n, 2) along x and y; ``places`` (m, 2) relative to the centres.
    """

    centers: Floats
    sizes: Floats
    places: Floats


def arrange(widths: Floats, nodes: Indices, edges: Indices) -> Arrangement:
    """Nodes in rows, those that share edges near each other.

    ``widths`` (n,) are what labels need; ``nodes`` and ``edges`` (m,) are the two ends of each
    incidence, by number.
    """
    count = len(widths)
    if not count:
        return Arrangement(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2)))
    degrees = np.bincount(nodes, minlength=count)
    fitting = np.floor((widths - 2 * INSET) / PITCH).astype(np.int64) + 1
    columns = np.maximum(np.ceil(np.sqrt(degrees)).astype(np.int64), np.minimum(fitting, degrees))
    columns = np.maximum(columns, 1)
    rows = np.maximum(-(-degrees // columns), 1)
    grids = np.column_stack([columns, rows])
    sizes = np.maximum(
        (grids - 1) * PITCH + 2 * INSET,
        np.column_stack([widths, np.full(count, LEAST_DEPTH)]),
    )
    centers = _in_rows(sizes, _embedding(nodes, edges, count), degrees > 0)
    return Arrangement(centers, sizes, _places(grids, centers, nodes, edges))


def _embedding(nodes: Indices, edges: Indices, count: int) -> Floats:
    """Coordinates (n, 2) at which nodes that share edges are near each other.

    Eigenvectors of the lazy random walk from nodes to edges and back (Zhou, Huang and Schölkopf,
    "Learning with hypergraphs", 2006), after the constant one, roughly.
    """
    degrees = np.maximum(np.bincount(nodes, minlength=count), 1).astype(np.float64)
    members = np.maximum(np.bincount(edges), 1).astype(np.float64)
    angles = np.arange(count) * 2.399963229728653  # the golden angle: no two nodes begin alike
    at = np.column_stack([np.cos(angles), np.sin(angles)])
    for _ in range(ROUNDS):
        for axis in range(2):
            means = np.bincount(edges, at[nodes, axis], len(members)) / members
            walked = np.bincount(nodes, means[edges], count) / degrees
            moved = at[:, axis] + walked
            moved = moved - (degrees * moved).sum() / degrees.sum()
            if axis == 1:
                first = at[:, 0]
                moved = moved - (degrees * moved * first).sum() * first
            length = np.sqrt((degrees * moved * moved).sum())
            at[:, axis] = moved / length if length > 1e-9 else 0.0
    return np.round(at, 9)


def _in_rows(sizes: Floats, at: Floats, joined: NDArray[np.bool_]) -> Floats:
    """Centres (n, 2) of nodes in rows: by ``at`` (n, 2), those in no edge last."""
    rooms = sizes + np.array([GAP, ROW_GAP])
    along = np.lexsort((at[:, 0], -at[:, 1], ~joined))
    ends = np.cumsum(rooms[along, 0])
    whole = float(ends[-1])
    wanted = np.sqrt(ASPECT * float(rooms.prod(axis=1).sum()))
    count = max(1, round(whole / wanted))
    row = np.empty(len(sizes), dtype=np.int64)
    row[along] = np.minimum((ends - rooms[along, 0] / 2) / whole * count, count - 1)
    order = np.lexsort((at[:, 0], row))
    ordered, width = row[order], rooms[order, 0]
    right = np.cumsum(width)
    totals = np.bincount(ordered, width, count)
    before = np.cumsum(totals) - totals
    depths = np.zeros(count)
    np.maximum.at(depths, row, rooms[:, 1])
    front = np.cumsum(depths)
    centers = np.empty((len(sizes), 2))
    centers[order, 0] = right - width / 2 - before[ordered] - totals[ordered] / 2
    centers[:, 1] = (front[-1] / 2 - front + depths / 2)[row]
    return centers


def _places(grids: Indices, centers: Floats, nodes: Indices, edges: Indices) -> Floats:
    """Places (m, 2) on grids (n, 2) of columns and rows: each on the side where its edge goes."""
    members = np.maximum(np.bincount(edges), 1)
    middles = np.column_stack(
        [np.bincount(edges, centers[nodes, axis]) / members for axis in range(2)]
    )[edges]
    degrees = np.bincount(nodes, minlength=len(centers))
    firsts = (np.cumsum(degrees) - degrees)[nodes]
    of_rows = grids[nodes, 1]
    ranks = np.empty(len(nodes), dtype=np.int64)
    ranks[np.lexsort((middles[:, 0], nodes))] = np.arange(len(nodes))
    column = (ranks - firsts) // of_rows
    ranks[np.lexsort((middles[:, 1], column, nodes))] = np.arange(len(nodes))
    row = ranks - firsts - column * of_rows
    cells = np.column_stack([column, row])
    return np.asarray((cells - (grids[nodes] - 1) / 2) * PITCH)
