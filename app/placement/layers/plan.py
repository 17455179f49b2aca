"""The whole plan: where items stand, and where nets run between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.terminals import Terminals
from app.program.port_rows import ROW


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A graph in layers; x to the right, v downwards, both in document units.

    ``items`` (n, 2) are the origins of items. ``object_heights`` (m,): v of the first rows of
    items and lanes. Of the g groups: ``trunks`` (g,) are the x of their trunks, NaN where they
    need none; ``depths`` (g,) how far trunks lie behind the ends, or, negative, before them where
    they dodge; ``channel_ends`` (g,): x of the right ends of their channels. Nets are numbered as
    in the graph, and so are their ``sources`` (h,), and the x of all ports, ``port_xs`` (p,).
    """

    terminals: Terminals
    items: Floats
    object_heights: Floats
    trunks: Floats
    depths: Floats
    channel_ends: Floats
    sources: Indices
    port_xs: Floats

    @property
    def terminal_heights(self) -> Floats:
        """V (t,) of all terminals."""
        terminals = self.terminals
        return np.asarray(
            self.object_heights[terminals.objects] + ROW * terminals.rows, dtype=np.float64
        )

    def moved(self, x: float, v: float) -> Plan:
        """The plan elsewhere."""
        return replace(
            self,
            items=self.items + np.array([x, v]),
            object_heights=self.object_heights + v,
            trunks=self.trunks + x,
            channel_ends=self.channel_ends + x,
            port_xs=self.port_xs + x,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Layers:
    """Plans of parts of a program that no hyperedge joins, and the ``nets`` of each plan.

    The k-th net of a plan is the hyperedge ``nets[k]``; all hyperedges are in one of the plans.
    """

    plans: tuple[Plan, ...]
    nets: tuple[Indices, ...]
