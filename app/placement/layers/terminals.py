"""What runs between the ranks: lanes, and where nets enter and leave the channels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Indices
from app.grouped import starts_of
from app.placement.layers.graph import Graph

LANE = -1
"""The net of an object that is an item."""

MOST_LANES, MOST_PAIRS = 100_000, 20_000_000
"""Lanes, and pairs of nets in one channel each, that are ordered."""


@dataclass(frozen=True, slots=True, eq=False)
class Terminals:
    """m objects in ranks, and t terminals of g groups.

    The objects are the items and then the lanes: one for each net and each rank that it passes.
    ``object_ranks`` (m,), ``object_spans`` (m,) in rows, ``object_nets`` (m,): the net of a lane,
    -1 of an item. Channel c lies between ranks c - 1 and c.

    A group is what one net has in one channel: ``group_channels`` and ``group_nets`` (g,), ordered
    by channel and net. Its terminals are ``group_starts[k]`` to ``group_starts[k + 1]``: those on
    the channel's left, and from ``group_middles[k]`` on those on its right. ``objects`` (t,) and
    ``rows`` (t,): which object they are on, and how many rows below its first; ``ports`` (t,), -1
    on lanes. Terminals of object o are ``by_object[object_starts[o]]`` and so on.
    """

    ranks: int
    items: int
    object_ranks: Indices
    object_spans: Indices
    object_nets: Indices
    group_channels: Indices
    group_nets: Indices
    group_starts: Indices
    group_middles: Indices
    objects: Indices
    rows: Indices
    ports: Indices
    by_object: Indices
    object_starts: Indices

    @property
    def groups(self) -> Indices:
        """The group (t,) of each terminal."""
        return np.repeat(np.arange(len(self.group_nets)), np.diff(self.group_starts))

    @property
    def channel_starts(self) -> Indices:
        """Where the groups of each channel start, (ranks + 2,)."""
        return np.searchsorted(self.group_channels, np.arange(self.ranks + 2))


class TooManyError(Exception):
    """There is more between the ranks of a graph than could be ordered in any useful time."""


def terminals(graph: Graph, ranks: Indices) -> Terminals:
    """The terminals of a graph whose items have ``ranks`` (n,).

    Raises `TooManyError` where there are more lanes, or more nets in one channel, than can be
    ordered.
    """
    nets = graph.port_nets
    items = len(ranks)
    channels = ranks[graph.port_items] + (graph.port_sides > 0)
    count = len(graph.net_starts) - 1
    first, last = np.full(count, np.iinfo(np.int64).max), np.full(count, -1)
    np.minimum.at(first, nets, channels)
    np.maximum.at(last, nets, channels)
    # A lane at each rank between two channels of a net.
    lanes = last - first
    width = int(last.max(initial=-1)) + 2
    begin, end = (np.bincount(at, minlength=width) for at in (first, last + 1))
    pairs = (np.cumsum(begin - end) ** 2).sum()
    if lanes.sum() > MOST_LANES or pairs > MOST_PAIRS:
        raise TooManyError
    lane_nets = np.repeat(np.arange(count), lanes)
    lane_ranks = (
        np.arange(len(lane_nets)) - np.repeat(starts_of(lanes)[:-1], lanes) + first[lane_nets]
    )
    lane_objects = items + np.arange(len(lane_nets))
    none = np.zeros(len(lane_nets), dtype=np.int64)
    of_channels = np.concatenate([channels, lane_ranks, lane_ranks + 1])
    of_nets = np.concatenate([nets, lane_nets, lane_nets])
    # What is on an item's right is on the left of a channel.
    is_right = np.concatenate([graph.port_sides < 0, none == 0, none == 1])
    objects = np.concatenate([graph.port_items, lane_objects, lane_objects])
    rows = np.concatenate([graph.port_rows, none, none])
    ports = np.concatenate([np.arange(len(nets)), none - 1, none - 1])
    order = np.lexsort((is_right, of_nets, of_channels))
    of_channels, of_nets, is_right = of_channels[order], of_nets[order], is_right[order]
    is_new = np.ones(len(order), dtype=np.bool_)
    is_new[1:] = (np.diff(of_channels) != 0) | (np.diff(of_nets) != 0)
    starts = np.append(np.flatnonzero(is_new), len(order))
    lefts = np.add.reduceat(~is_right, starts[:-1]) if len(order) else np.zeros(0, dtype=np.int64)
    objects = objects[order]
    object_count = items + len(lane_nets)
    return Terminals(
        ranks=int(ranks.max(initial=-1)) + 1,
        items=items,
        object_ranks=np.concatenate([ranks, lane_ranks]),
        object_spans=np.concatenate([graph.spans, none]),
        object_nets=np.concatenate([np.full(items, LANE), lane_nets]),
        group_channels=of_channels[starts[:-1]],
        group_nets=of_nets[starts[:-1]],
        group_starts=starts,
        group_middles=starts[:-1] + lefts,
        objects=objects,
        rows=rows[order],
        ports=ports[order],
        by_object=np.argsort(objects, kind="stable"),
        object_starts=starts_of(np.bincount(objects, minlength=object_count)),
    )
