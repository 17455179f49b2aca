"""The row of every object: as little vertical way as the order of each rank allows."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices
from app.placement.layers.graph import Graph
from app.placement.layers.simplex import solve
from app.placement.layers.terminals import LANE, Terminals
from app.program.port_rows import ROW

LANES, ACROSS_LANE, ACROSS, TURNING = 2000, 300, 200, 60
"""Weights of vertical way, in hundredths: between two lanes, between a lane and a port, between
two ports across a channel, between two terminals on one side of it."""

FEW = 6
"""Above so many terminals of one group each is drawn to one height instead of to all others."""

AIR_OF_ITEM, AIR_OF_LANE = 0.33, 0.06
"""Free height beside an item, and between lanes, document units."""

WORK = 1_000_000_000
"""Looks at edges until the heights are good enough."""


def heights(graph: Graph, terminals: Terminals, order: Indices) -> Indices:
    """Rows (m,) of the first rows of objects, downwards from 0, in the ``order`` (m,) of ranks."""
    count = len(order)
    upper, lower, gaps = _gaps(graph, terminals, order)
    start = _packed(count, upper, lower, gaps)
    bonds = _bonds(terminals)
    # |height of one - height of another| is what both lie below a node of its own.
    above, below = bonds[:, 0], bonds[:, 1]
    objects, rows = terminals.objects, terminals.rows
    tails = [upper]
    heads = [lower]
    lengths = [gaps]
    weights = [np.zeros(len(gaps), dtype=np.int64)]
    first = count
    between = first + np.arange(len(bonds))
    middle = np.minimum(start[objects[above]] + rows[above], start[objects[below]] + rows[below])
    for ends in (above, below):
        tails.append(between)
        heads.append(objects[ends])
        lengths.append(-rows[ends])
        weights.append(bonds[:, 2])
    hubs, hub_start = _hubs(terminals, start, first + len(bonds))
    for part, more in zip((tails, heads, lengths, weights), hubs, strict=True):
        part.extend(more)
    begin = np.concatenate([start, middle, hub_start])
    found = solve(
        len(begin),
        np.concatenate(tails),
        np.concatenate(heads),
        np.concatenate(lengths),
        np.concatenate(weights),
        WORK,
        begin,
    )[:count]
    return np.asarray(found - found.min(initial=0))


def _gaps(graph: Graph, terminals: Terminals, order: Indices) -> tuple[Indices, Indices, Indices]:
    """Neighbours in ranks, the upper and the lower one, and rows between their first rows."""
    ranks = terminals.object_ranks[order]
    beside = np.flatnonzero(ranks[1:] == ranks[:-1])
    upper, lower = order[beside], order[beside + 1]
    radii = graph.radii[terminals.object_nets[terminals.items :]]
    up = np.concatenate([graph.extents[:, 2], radii])
    down = np.concatenate([graph.extents[:, 3], radii])
    is_item = terminals.object_nets == LANE
    either, both = is_item[upper] | is_item[lower], is_item[upper] & is_item[lower]
    air = np.where(either, AIR_OF_ITEM, AIR_OF_LANE)
    needed = np.ceil((down[upper] + up[lower] + air) / ROW - 1e-9).astype(np.int64)
    return upper, lower, np.maximum(needed, terminals.object_spans[upper] + 1 + both)


def _packed(count: int, upper: Indices, lower: Indices, gaps: Indices) -> Indices:
    """Heights (m,) of objects that stand as near to each other as they may."""
    found = np.zeros(count, dtype=np.int64)
    for one, other, gap in zip(upper.tolist(), lower.tolist(), gaps.tolist(), strict=True):
        found[other] = found[one] + gap
    return found


def _bonds(terminals: Terminals) -> Indices:
    """Pairs of terminals of small groups, and their weights: (b, 3)."""
    found: list[tuple[int, int, int]] = []
    is_lane = (terminals.object_nets != LANE)[terminals.objects].tolist()
    for first, middle, end in zip(
        terminals.group_starts[:-1].tolist(),
        terminals.group_middles.tolist(),
        terminals.group_starts[1:].tolist(),
        strict=True,
    ):
        if end - first > FEW:
            continue
        share = max(1.0, 0.5 * (middle - first) * (end - middle))
        for one in range(first, end):
            for other in range(one + 1, end):
                if (one < middle) == (other < middle):
                    weight: float = TURNING
                elif is_lane[one] and is_lane[other]:
                    weight = LANES
                else:
                    weight = (ACROSS_LANE if is_lane[one] or is_lane[other] else ACROSS) / share
                found.append((one, other, round(weight)))
    return np.array(found, dtype=np.int64).reshape(-1, 3)


def _hubs(
    terminals: Terminals, start: Indices, first: int
) -> tuple[tuple[list[Indices], ...], Indices]:
    """Edges that draw the terminals of large groups to one height each, and where they start.

    The height of a group is a node, numbered from ``first`` on, and so is the lower one of it and
    of each terminal.
    """
    large = np.flatnonzero(np.diff(terminals.group_starts) > FEW)
    edges: tuple[list[Indices], ...] = ([], [], [], [])
    starts: list[Indices] = []
    for group in large.tolist():
        rows = np.arange(terminals.group_starts[group], terminals.group_starts[group + 1])
        on, offsets = terminals.objects[rows], terminals.rows[rows]
        at = start[on] + offsets
        hub = first
        between = hub + 1 + np.arange(len(rows))
        first += 1 + len(rows)
        height = np.sort(at)[len(at) // 2]
        starts.extend((np.array([height]), np.minimum(at, height)))
        for heads, lengths in ((on, -offsets), (np.full(len(rows), hub), 0 * offsets)):
            edges[0].append(between)
            edges[1].append(heads)
            edges[2].append(lengths)
            edges[3].append(np.full(len(rows), ACROSS))
    return edges, np.concatenate(starts) if starts else np.zeros(0, dtype=np.int64)
