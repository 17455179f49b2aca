"""A graph in layers, from ranks to channels: the best of some orders."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.channels import across, depths
from app.placement.layers.folding import cuts_of, folded
from app.placement.layers.graph import Graph
from app.placement.layers.heights import heights
from app.placement.layers.order import order, spaces_of
from app.placement.layers.plan import Plan
from app.placement.layers.ranks import ranks
from app.placement.layers.terminals import Terminals, terminals
from app.placement.layers.tracks import STRAIGHT, tracks
from app.program.port_rows import ROW

SWEEPS = 24
RESTARTS = 120
"""Orders that are looked for in a small graph."""

COMPLETED = 4
"""Of these so many, those with the fewest crossings, are completed."""

PAIRS = 1_000_000
"""Pairs of nets in channels that all restarts together look at, roughly, each time they count."""

DODGE, TRUNK, LENGTH = 3.0, 0.25, 0.01
"""What a dodge, a trunk and a unit of vertical way cost beside a crossing."""


def layered(graph: Graph, clearance: float) -> Plan:
    """Where the items of a connected graph stand, and where its nets run between them.

    Tubes have ``clearance`` between them. What would be a long line is folded into some.
    """
    found = ranks(graph)
    plan = _planned(graph, found, clearance)
    cuts = cuts_of(graph, plan)
    if not len(cuts):
        return plan
    # A rank of lanes alone before each rank that begins a new line.
    moved = found + np.searchsorted(cuts, found, "right")
    return folded(graph, _planned(graph, moved, clearance), cuts + np.arange(len(cuts)), clearance)


def _planned(graph: Graph, found: Indices, clearance: float) -> Plan:
    """The plan in one line of ranks (n,)."""
    between = terminals(graph, found)
    best: tuple[float, Indices, Indices, Indices] | None = None
    for objects in _orders(between):
        rows = heights(graph, between, objects)
        at = (rows[between.objects] + between.rows).astype(np.float64)
        chosen, dodges, crossings = tracks(
            between.channel_starts, between.group_starts, between.group_middles, at
        )
        cost = crossings + DODGE * np.count_nonzero(dodges)
        cost += TRUNK * np.count_nonzero(chosen != STRAIGHT)
        cost += LENGTH * ROW * _vertical(between, at)
        if best is None or cost < best[0] - 1e-9:
            best = cost, rows, chosen, dodges
    assert best is not None, "there is an order"  # noqa: S101
    _, rows, chosen, dodges = best
    xs, trunks, ends = across(graph, between, chosen, dodges, clearance)
    return Plan(
        terminals=between,
        items=np.stack([xs, ROW * rows[: between.items]], axis=1),
        terminal_heights=ROW * (rows[between.objects] + between.rows).astype(np.float64),
        trunks=trunks,
        depths=depths(graph, between, dodges, clearance),
        channel_ends=ends,
        sources=graph.sources,
        port_xs=xs[graph.port_items] + graph.port_xs,
        turning=np.zeros(0, dtype=np.int64),
        turns=np.zeros((0, 3)),
    )


def _orders(between: Terminals) -> list[Indices]:
    """The orders with the fewest crossings, from the document's and from shuffled ones."""
    count = len(between.object_ranks)
    pairs = int((np.diff(between.channel_starts) ** 2).sum())
    restarts = max(1, min(RESTARTS, PAIRS // max(pairs, 1)))
    spaces = spaces_of(between)
    found: list[tuple[int, int, Indices]] = []
    for restart in range(restarts):
        start = np.arange(count)
        if restart:
            start = np.random.default_rng(restart).permutation(count)
        result, crossings = order(between, start, SWEEPS, spaces)
        found.append((crossings, restart, result))
    found.sort(key=lambda each: each[:2])
    return [result for _, _, result in found[:COMPLETED]]


def _vertical(between: Terminals, at: Floats) -> float:
    """Rows that all trunks are long."""
    if not len(at):
        return 0.0
    starts = between.group_starts[:-1]
    return float((np.maximum.reduceat(at, starts) - np.minimum.reduceat(at, starts)).sum())
