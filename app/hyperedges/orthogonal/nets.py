"""What each net of a plan has in the channels that it runs through."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.placement.layers.plan import Plan
from app.placement.layers.terminals import LANE

Point = tuple[float, float, float]
"""X to the right, depth away from the reader, z up."""


@dataclass(frozen=True, slots=True)
class Terminal:
    """An end of a net in one of its channels: at a port, or at a lane that leads to another."""

    number: int
    height: float
    side: int
    port: int
    lane: int

    @property
    def heading(self) -> Point:
        """Out of the channel."""
        return (float(self.side), 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Channel:
    """What a net has in one channel; ``trunk`` is ``None`` where it runs straight."""

    terminals: tuple[Terminal, ...]
    trunk: float | None
    depth: float
    end: float

    @property
    def dodges(self) -> bool:
        """Whether it runs in front of the others here."""
        return self.depth < 0.0


@dataclass(frozen=True, slots=True)
class Net:
    """A net's channels, and for its source and each lane's other end: channel and place there.

    ``turns`` are, of lanes at which it goes on in another line, the x, z and x where it turns.
    """

    channels: tuple[Channel, ...]
    source: tuple[int, int]
    beyond: dict[tuple[int, int], tuple[int, int]]
    turns: dict[int, Point]
    port_xs: Floats


def nets_of(plan: Plan) -> list[Net]:
    """What each net has in its channels."""
    terminals = plan.terminals
    heights = (-plan.terminal_heights).tolist()
    lanes = np.where(
        terminals.object_nets[terminals.objects] == LANE, LANE, terminals.objects
    ).tolist()
    ports = terminals.ports.tolist()
    turns: dict[int, Point] = {
        lane: (right, -v, left)
        for lane, (right, v, left) in zip(plan.turning.tolist(), plan.turns.tolist(), strict=True)
    }
    order = np.argsort(terminals.group_nets, kind="stable")
    starts = np.searchsorted(terminals.group_nets[order], np.arange(len(plan.sources) + 1))
    found: list[Net] = []
    for net, source in enumerate(plan.sources.tolist()):
        channels: list[Channel] = []
        begin = (-1, -1)
        at_lane: dict[int, tuple[int, int]] = {}
        beyond: dict[tuple[int, int], tuple[int, int]] = {}
        for group in order[starts[net] : starts[net + 1]].tolist():
            ends: list[Terminal] = []
            for t in range(terminals.group_starts[group], terminals.group_starts[group + 1]):
                here = len(channels), len(ends)
                side = -1 if t < terminals.group_middles[group] else 1
                ends.append(Terminal(t, heights[t], side, ports[t], lanes[t]))
                if ports[t] == source:
                    begin = here
                if lanes[t] != LANE:
                    other = at_lane.setdefault(lanes[t], here)
                    beyond[here], beyond[other] = other, here
            channels.append(_channel(plan, group, tuple(ends)))
        found.append(Net(tuple(channels), begin, beyond, turns, plan.port_xs))
    return found


def _channel(plan: Plan, group: int, ends: tuple[Terminal, ...]) -> Channel:
    trunk = float(plan.trunks[group])
    return Channel(
        ends,
        None if np.isnan(trunk) else trunk,
        float(plan.depths[group]),
        float(plan.channel_ends[group]),
    )
