"""The whole plan: where items stand, and where nets run between them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats, Indices
from app.placement.layers.terminals import Terminals


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """A graph in layers; x to the right, v downwards, both in document units.

    ``items`` (n, 2) are the origins of items, ``terminal_heights`` (t,) the v of terminals. Of the
    g groups: ``trunks`` (g,) are the x of their trunks, NaN where they
    need none; ``depths`` (g,) how far trunks lie behind the ends, or, negative, before them where
    they dodge; ``channel_ends`` (g,): x of the right ends of their channels. Nets are numbered as
    in the graph, and so are their ``sources`` (h,), and the x of all ports, ``port_xs`` (p,).

    At each lane ``turning`` (f,), objects by number, a net leaves one line of columns for the next
    one below: there it turns down at the first x of ``turns`` (f, 3), runs back to the left at the
    v that is second, and turns down at the last x.
    """

    terminals: Terminals
    items: Floats
    terminal_heights: Floats
    trunks: Floats
    depths: Floats
    channel_ends: Floats
    sources: Indices
    port_xs: Floats
    turning: Indices
    turns: Floats

    def moved(self, x: float, v: float) -> Plan:
        """The plan elsewhere."""
        return replace(
            self,
            items=self.items + np.array([x, v]),
            terminal_heights=self.terminal_heights + v,
            trunks=self.trunks + x,
            channel_ends=self.channel_ends + x,
            port_xs=self.port_xs + x,
            turns=self.turns + np.array([x, v, x]),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Layers:
    """Plans of parts of a program that no hyperedge joins, and the ``nets`` of each plan.

    The k-th net of a plan is the hyperedge ``nets[k]``; all hyperedges are in one of the plans.
    """

    plans: tuple[Plan, ...]
    nets: tuple[Indices, ...]
