"""What is laid out in layers: items with ports on their left and right sides, joined by nets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of


@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """n items, p ports, and h nets that join the ports. Lengths are document units.

    ``extents`` (n, 4): how far each item reaches to the left, to the right, up and down from its
    origin, which is its middle across and its first row of ports down. ``halves`` (n,): half the
    width of its body, on whose sides the ports are. ``spans`` (n,): rows from its first port to its
    last. ``is_state`` (n,): items at which cycles begin; ``is_last`` (n,): those that share the
    last rank.

    ``port_items`` (p,), ``port_sides`` (p,): -1 left, 1 right; ``port_rows`` (p,): rows below the
    item's first; ``port_xs`` (p,): how far right of the item's middle. Ports of net k are
    ``net_starts[k]`` to ``net_starts[k + 1]``; ``sources`` (h,) are the ports that drive the nets.
    ``radii`` (h,) are the tubes'; ``weights`` (h,) say how short nets should be, in hundredths.
    """

    extents: Floats
    halves: Floats
    spans: Indices
    is_state: Flags
    is_last: Flags
    port_items: Indices
    port_sides: Indices
    port_rows: Indices
    port_xs: Floats
    net_starts: Indices
    sources: Indices
    radii: Floats
    weights: Indices

    @property
    def port_nets(self) -> Indices:
        """The net (p,) of each port."""
        return np.repeat(np.arange(len(self.net_starts) - 1), np.diff(self.net_starts))

    @property
    def edges(self) -> tuple[Indices, Indices, Indices, Flags]:
        """From which item to which nets go, and their numbers: each (e,), for every other end.

        The last says whether they go from an item's right to another's left.
        """
        nets = self.port_nets
        sinks = np.ones(len(nets), dtype=np.bool_)
        sinks[self.sources] = False
        ends = np.flatnonzero(sinks)
        tails, heads = self.port_items[self.sources[nets[ends]]], self.port_items[ends]
        hard = (self.port_sides[self.sources[nets[ends]]] > 0) & (self.port_sides[ends] < 0)
        keep = tails != heads
        return tails[keep], heads[keep], nets[ends][keep], hard[keep]

    def part(self, items: Indices, nets: Indices) -> Graph:
        """The graph of some ``items`` and of ``nets`` that join none but these, in that order."""
        ports = rows_of(self.net_starts, nets)
        counts = np.diff(self.net_starts)[nets]
        starts = starts_of(counts)
        numbers = np.full(len(self.halves), -1, dtype=np.int64)
        numbers[items] = np.arange(len(items))
        return Graph(
            extents=self.extents[items],
            halves=self.halves[items],
            spans=self.spans[items],
            is_state=self.is_state[items],
            is_last=self.is_last[items],
            port_items=numbers[self.port_items[ports]],
            port_sides=self.port_sides[ports],
            port_rows=self.port_rows[ports],
            port_xs=self.port_xs[ports],
            net_starts=starts,
            sources=self.sources[nets] - self.net_starts[nets] + starts[:-1],
            radii=self.radii[nets],
            weights=self.weights[nets],
        )
