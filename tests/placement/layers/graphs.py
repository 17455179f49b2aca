"""Graphs of items of one size, whose nets go from the right of the first item to others' left."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from app.grouped import starts_of
from app.placement.layers.graph import Graph
from app.program.port_rows import ROW


def graph_of(items: int, nets: Sequence[Sequence[int]], last: Sequence[int] = ()) -> Graph:
    """A graph of so many ``items``; each net has its source first. Ports stand in their order."""
    counts: Counter[tuple[int, int]] = Counter()
    ports: list[tuple[int, int, int]] = []
    for net in nets:
        for place, item in enumerate(net):
            side = -1 if place else 1
            ports.append((item, side, counts[item, side]))
            counts[item, side] += 1
    owners, sides, rows = np.array(ports, dtype=np.int64).reshape(-1, 3).T
    starts = starts_of(np.array([len(net) for net in nets], dtype=np.int64))
    spans = np.array(
        [max(counts[item, -1], counts[item, 1], 1) - 1 for item in range(items)], dtype=np.int64
    )
    down = ROW * spans + 0.3
    return Graph(
        extents=np.stack([np.full(items, 0.5), np.full(items, 0.5), np.full(items, 0.3), down], 1),
        halves=np.full(items, 0.5),
        spans=spans,
        is_state=np.zeros(items, dtype=np.bool_),
        is_last=np.isin(np.arange(items), last),
        port_items=owners,
        port_sides=sides,
        port_rows=rows,
        port_xs=0.5 * sides.astype(np.float64),
        net_starts=starts,
        sources=starts[:-1],
        radii=np.full(len(nets), 0.06),
        weights=np.full(len(nets), 100),
    )
