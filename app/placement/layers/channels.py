"""How wide channels are: x of columns and trunks, and how deep trunks lie."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.graph import Graph
from app.placement.layers.terminals import Terminals
from app.placement.layers.tracks import STRAIGHT

CORNER = 0.28
"""In which a way turns from level to upright and changes its depth, document units."""

NARROWEST = 0.42
"""Between two trunks at least."""

MARGIN = 0.45
"""Between the body of an item and the first corner."""

LETTERS = 0.2
"""Between what is written beside an item and the first corner."""

EMPTY = 0.9
"""Width of a channel without trunks."""

DIVE = 1.2
"""At the right end of a channel in which something dodges: there it comes back."""

ABOVE = 2.3
"""Depth of trunks at least, over their radius."""

AIR = 0.03
"""Between tubes, beside the clearance that is wanted."""


def across(
    graph: Graph, terminals: Terminals, found: Indices, dodges: Indices, clearance: float
) -> tuple[Floats, Floats, Floats]:
    """X of items (n,), of trunks (g,), and of the right ends of groups' channels (g,).

    ``found`` and ``dodges`` (g,) are the groups' tracks and dodges.
    """
    items = np.zeros(len(graph.halves))
    trunks = np.full(len(found), np.nan)
    ends = np.zeros(len(found))
    ranks = terminals.object_ranks[: terminals.items]
    starts = terminals.channel_starts
    x = 0.0
    for channel in range(terminals.ranks + 1):
        groups = np.arange(starts[channel], starts[channel + 1])
        left, right = ranks == channel - 1, ranks == channel
        from_left = _margin(graph, left, 1)
        from_right = _margin(graph, right, 0)
        x, trunks[groups] = _trunks(
            x + from_left, graph.radii[terminals.group_nets[groups]], found[groups], clearance
        )
        if (found[groups] == STRAIGHT).all():
            x = x - from_left + max(EMPTY, from_left, from_right)
        elif dodges[groups].any():
            x += max(from_right, DIVE)
        else:
            x += from_right
        if channel == 0 and not len(groups):
            x = 0.0
        ends[groups] = x
        if right.any():
            wide = graph.halves[right].max()
            items[right] = x + wide
            x += 2 * wide
    return items, trunks, ends


def _margin(graph: Graph, column: Indices, side: int) -> float:
    """Room that a column needs at its left (0) or right (1), from its widest body on."""
    if not column.any():
        return MARGIN
    halves = graph.halves[column]
    letters = graph.extents[column, side] - halves
    beside = np.where(letters > 1e-9, letters + LETTERS, 0.0)
    return max(MARGIN, float((halves + beside).max() - halves.max()))


def _trunks(x: float, radii: Floats, found: Indices, clearance: float) -> tuple[float, Floats]:
    """X behind the last corner, and of each trunk, where the first corner may begin at ``x``."""
    trunks = np.full(len(found), np.nan)
    before = 0.0
    for track in range(int(found.max(initial=STRAIGHT)) + 1):
        members = found == track
        radius = float(radii[members].max())
        pitch = max(NARROWEST, CORNER + before + radius + clearance + 0.1)
        x += CORNER if track == 0 else pitch
        trunks[members] = x
        before = radius
    return x + (CORNER if before else 0.0), trunks


def depths(graph: Graph, terminals: Terminals, dodges: Indices, clearance: float) -> Floats:
    """How far trunks (g,) lie behind the ends of nets: in front, and so negative, if they dodge.

    Of those that dodge in a channel the leftmost is foremost: level with its way to the right may
    be the end of one that turns forward behind it.
    """
    found = np.zeros(len(dodges))
    starts = terminals.channel_starts
    apart = clearance + AIR
    for channel in range(terminals.ranks + 1):
        groups = np.arange(starts[channel], starts[channel + 1])
        radii = graph.radii[terminals.group_nets[groups]]
        if not len(radii):
            continue
        # The thickest of the others.
        order = np.sort(radii)
        second = order[-2] if len(order) > 1 else 0.0
        others = np.where(radii == order[-1], second, order[-1])
        deep = np.maximum(ABOVE * radii, radii + others + apart)
        last = None
        for number in np.argsort(-dodges[groups], kind="stable").tolist():
            if dodges[groups[number]]:
                if last is not None:
                    deep[number] = max(
                        deep[number], deep[last] + radii[last] + radii[number] + apart
                    )
                last = number
        found[groups] = np.where(dodges[groups] > 0, -deep, deep)
    return found
