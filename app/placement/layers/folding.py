"""Long lines of columns, folded: some lines below each other, each read from left to right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.channels import CORNER, NARROWEST
from app.placement.layers.graph import Graph
from app.placement.layers.plan import Plan

LONG = 5.0
"""Width over height from which on a line is folded."""

ASPECT = 1.6
"""Width over height that is aimed at then."""

BETWEEN = 2.4
"""Height between two lines, roughly, document units."""

SEARCHED = 0.25
"""How far from where lines would have one length cuts are looked for, in lengths of a line."""

BESIDE = 0.6
"""Between a line and the nearest tube that runs back, document units."""


def cuts_of(graph: Graph, plan: Plan) -> Indices:
    """The ranks before which a plan of one line is cut, ascending: none where it is not long.

    It is cut where few nets pass.
    """
    terminals = plan.terminals
    items, ranks = plan.items, terminals.object_ranks[: terminals.items]
    width = float(np.ptp(items[:, 0]))
    height = float(np.ptp(plan.terminal_heights)) + float(graph.extents[:, 2:].max())
    if width <= LONG * height:
        return np.zeros(0, dtype=np.int64)
    lines = max(1, round(float(np.sqrt(width / (ASPECT * (height + BETWEEN))))))
    lefts = np.full(terminals.ranks, np.inf)
    np.minimum.at(lefts, ranks, items[:, 0])
    passing = np.bincount(terminals.group_channels[_passes(plan)], minlength=terminals.ranks)
    cuts: list[int] = []
    for line in range(1, lines):
        aim = float(items[:, 0].min()) + width * line / lines
        near = np.flatnonzero(np.abs(lefts - aim) <= SEARCHED * width / lines)
        near = near[near > (cuts[-1] if cuts else 0)]
        if len(near):
            order = np.lexsort((np.abs(lefts[near] - aim), passing[near]))
            cuts.append(int(near[order[0]]))
    return np.array(cuts, dtype=np.int64)


def _passes(plan: Plan) -> Indices:
    """The groups of nets that go through their channel from side to side."""
    starts, middles = plan.terminals.group_starts, plan.terminals.group_middles
    return np.flatnonzero((starts[:-1] < middles) & (middles < starts[1:]))


def folded(graph: Graph, plan: Plan, turns: Indices, clearance: float) -> Plan:
    """The plan of one line, in lines that end at the ranks ``turns`` (f,), which have lanes alone.

    From line to line, nets run back between the two: none crosses another, since who leaves a line
    at its top runs lowest, and farthest to the left again.
    """
    terminals = plan.terminals
    ranks = terminals.object_ranks
    lines = np.searchsorted(turns, ranks, "left")
    # Channel c ends at rank c: at a turn it is still in the line that ends there.
    group_lines = np.searchsorted(turns, terminals.group_channels, "left")
    terminal_lines = group_lines[terminals.groups]
    item_lines = lines[: terminals.items]
    pitch = max(NARROWEST, 2 * float(graph.radii.max()) + clearance + 0.1)
    shifts = np.zeros((len(turns) + 1, 2))
    turning: list[int] = []
    ways: list[tuple[float, float, float]] = []
    bottom = _reach(graph, plan, item_lines, terminal_lines, 0)[1]
    for line, rank in enumerate(turns.tolist()):
        lanes = np.flatnonzero(ranks == rank)
        # All terminals of a lane have one height.
        heights = plan.terminal_heights[terminals.by_object[terminals.object_starts[lanes]]]
        lanes = lanes[np.argsort(heights, kind="stable")]
        count = len(lanes)
        end = float(plan.channel_ends[terminals.group_channels == rank].max())
        top = _reach(graph, plan, item_lines, terminal_lines, line + 1)[0]
        back = bottom + BESIDE
        below = back + pitch * count + BESIDE
        begin = CORNER + pitch * count
        right = end + shifts[line, 0] + CORNER
        shifts[line + 1] = begin - end, below - top
        for place, lane in enumerate(lanes.tolist()):
            outer = count - 1 - place
            turning.append(lane)
            ways.append((right + pitch * outer, back + pitch * outer, pitch * (outer + 0.5)))
        bottom = below - top + _reach(graph, plan, item_lines, terminal_lines, line + 1)[1]
    return replace(
        plan,
        items=plan.items + shifts[item_lines],
        terminal_heights=plan.terminal_heights + shifts[terminal_lines, 1],
        trunks=plan.trunks + shifts[group_lines, 0],
        channel_ends=plan.channel_ends + shifts[group_lines, 0],
        port_xs=plan.port_xs + shifts[item_lines[graph.port_items], 0],
        turning=np.array(turning, dtype=np.int64),
        turns=np.array(ways),
    )


def _reach(
    graph: Graph, plan: Plan, item_lines: Indices, terminal_lines: Indices, line: int
) -> tuple[float, float]:
    """From which v to which a line reaches, before it is moved."""
    items = np.flatnonzero(item_lines == line)
    heights = plan.terminal_heights[terminal_lines == line]
    radius = float(graph.radii.max())
    tops = plan.items[items, 1] - graph.extents[items, 2]
    bottoms = plan.items[items, 1] + graph.extents[items, 3]
    ends: list[Floats] = [heights - radius, heights + radius, tops, bottoms]
    every = np.concatenate(ends)
    return float(every.min()), float(every.max())
