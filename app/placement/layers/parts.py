"""Parts of a graph that no net joins, each in layers, one below another."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.graph import Graph
from app.placement.layers.layered import layered
from app.placement.layers.plan import Layers, Plan
from app.program.port_rows import ROW

BETWEEN = 2 * ROW
"""Between two parts, document units."""


def in_parts(graph: Graph, clearance: float) -> tuple[Floats, Layers]:
    """Origins (n, 2) of all items, x to the right and v downwards, and the plans.

    The part with the most items stands at the top; items without nets stand in a row at the bottom.
    """
    count = len(graph.halves)
    origins = np.zeros((count, 2))
    labels = _parts(graph)
    nets = labels[graph.port_items[graph.sources]]
    sizes = np.bincount(labels, minlength=count)
    used = np.unique(nets)
    plans: list[Plan] = []
    numbers: list[Indices] = []
    bottom = 0.0
    for label in used[np.lexsort((used, -sizes[used]))].tolist():
        items, here = np.flatnonzero(labels == label), np.flatnonzero(nets == label)
        part = graph.part(items, here)
        plan = layered(part, clearance)
        tops = plan.items[:, 1] - part.extents[:, 2]
        top = min(float(tops.min()), float(plan.terminal_heights.min()) - float(part.radii.max()))
        plan = plan.moved(0.0, bottom - top)
        lowest = float((plan.items[:, 1] + part.extents[:, 3]).max())
        bottom = max(lowest, float(plan.terminal_heights.max())) + BETWEEN
        origins[items] = plan.items
        plans.append(plan)
        numbers.append(here)
    alone = np.flatnonzero(~np.isin(labels, used))
    if len(alone):
        x = np.cumsum(graph.extents[alone, :2].sum(axis=1) + ROW)
        origins[alone, 0] = x - graph.extents[alone, 1] - ROW
        origins[alone, 1] = bottom + graph.extents[alone, 2].max()
    return origins, Layers(tuple(plans), tuple(numbers))


def _parts(graph: Graph) -> Indices:
    """The part (n,) of each item: the least number of the items that nets join it to."""
    parts = np.arange(len(graph.halves))
    nets = graph.port_nets
    while True:
        least = np.full(len(graph.sources), len(parts))
        np.minimum.at(least, nets, parts[graph.port_items])
        found = parts.copy()
        np.minimum.at(found, graph.port_items, least[nets])
        found = found[found]
        if (found == parts).all():
            return found
        parts = found
