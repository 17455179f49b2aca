"""The vertices and edges that a net runs along: level ends, upright trunks, switches at joins."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.arrays import Floats
from app.hyperedges.orthogonal.nets import Channel, Net, Point, Terminal, nets_of
from app.placement.layers.channels import CORNER
from app.placement.layers.plan import Plan
from app.placement.layers.terminals import LANE

LEVEL_STEP = 0.2
"""Between two joins before a trunk, document units."""

UPRIGHT_STEP = 0.03
"""Between two joins of a trunk for ends of one height: rows leave no more beside two corners."""

DIVE_FROM, DIVE_TO = 0.8, 0.05
"""Where what dodges comes back to the others, before the right end of its channel."""

SAME = 1e-6


@dataclass(slots=True)
class Skeleton:
    """A tree with directions: ``points`` and unit ``tangents`` of vertices, ``edges`` between them.

    ``ports`` are the vertices' ports, -1 within the tree. Edges go away from the source.
    """

    points: list[Point] = field(default_factory=list)
    tangents: list[Point] = field(default_factory=list)
    ports: list[int] = field(default_factory=list)
    edges: list[tuple[int, int]] = field(default_factory=list)

    def vertex(self, point: Point, tangent: Point, port: int = -1) -> int:
        """Add a vertex; its number."""
        self.points.append(point)
        self.tangents.append(tangent)
        self.ports.append(port)
        return len(self.points) - 1

    def extend(self, start: int, point: Point, tangent: Point, port: int = -1) -> int:
        """Add a vertex and the edge from ``start`` to it; its number."""
        number = self.vertex(point, tangent, port)
        self.edges.append((start, number))
        return number


def skeletons(plan: Plan) -> list[Skeleton]:
    """The skeleton of each net of a plan."""
    return [_skeleton(net) for net in nets_of(plan)]


def _skeleton(net: Net) -> Skeleton:
    found = Skeleton()
    channel, place = net.source
    source = net.channels[channel].terminals[place]
    heading = (-float(source.side), 0.0, 0.0)
    root = found.vertex((float(net.port_xs[source.port]), 0.0, source.height), heading, source.port)
    waiting = [(channel, place, root)]
    while waiting:
        channel, place, start = waiting.pop()
        crossing = _Crossing(found, net.channels[channel], place, net.port_xs)
        for number, vertex in crossing.run(start):
            here, there = (channel, number), net.beyond[(channel, number)]
            ends = [net.channels[which].terminals[at] for which, at in (here, there)]
            turn = net.turns.get(ends[0].lane)
            after = vertex if turn is None else _turn(found, vertex, ends[0], ends[1], turn)
            waiting.append((*there, after))
    return found


def _turn(found: Skeleton, start: int, here: Terminal, there: Terminal, turn: Point) -> int:
    """Run from one line of columns to the next, or back; the vertex at which it goes on."""
    right, height, left = turn
    upper, lower = (here, there) if here.side > 0 else (there, here)
    down, level = (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
    back = (-1.0, 0.0, 0.0)
    way: list[tuple[Point, Point]] = [
        ((right - CORNER, 0.0, upper.height), level),
        ((right, 0.0, upper.height - CORNER), down),
        ((right, 0.0, height + CORNER), down),
        ((right - CORNER, 0.0, height), back),
        ((left + CORNER, 0.0, height), back),
        ((left, 0.0, height - CORNER), down),
        ((left, 0.0, lower.height + CORNER), down),
        ((left + CORNER, 0.0, lower.height), level),
    ]
    if upper is not here:
        way = [(point, (-x, -y, -z)) for point, (x, y, z) in reversed(way)]
    for point, heading in way:
        start = found.extend(start, point, heading)
    return start


class _Crossing:
    """How a net runs through one channel, from one of its ends there to all others."""

    def __init__(self, skeleton: Skeleton, channel: Channel, place: int, port_xs: Floats) -> None:
        self._skeleton = skeleton
        self._channel = channel
        self._source = channel.terminals[place]
        self._others = [
            (number, end) for number, end in enumerate(channel.terminals) if number != place
        ]
        self._port_xs = port_xs
        self._lanes: list[tuple[int, int]] = []

    def run(self, start: int) -> list[tuple[int, int]]:
        """Run from the vertex ``start``; places of lanes, and the vertices at which they begin."""
        channel, source = self._channel, self._source
        if channel.trunk is None:
            for number, end in self._others:
                self._land(start, number, end)
            return self._lanes
        height = source.height
        level = [each for each in self._others if abs(each[1].height - height) <= SAME]
        arms = [
            sorted(
                (each for each in self._others if way * (each[1].height - height) > SAME),
                key=lambda each: abs(each[1].height - height),
            )
            for way in (1, -1)
        ]
        joins = bool(level) + bool(arms[0]) + bool(arms[1]) - 1
        stem, depth = self._stem(start, max(1, joins))
        for number, end in level:
            begin = stem[0]
            if depth:
                x = channel.trunk - CORNER - 0.3
                begin = self._skeleton.extend(begin, (x, 0.0, height), end.heading)
            self._land(begin, number, end)
        for way, arm in zip((1, -1), arms, strict=True):
            if arm:
                self._climb(stem[-1], way, arm)
        return self._lanes

    def _stem(self, start: int, joins: int) -> tuple[list[int], float]:
        """Level vertices from which a trunk branches off, and the depth that they are in."""
        channel, source = self._channel, self._source
        assert channel.trunk is not None, "there is a trunk to reach"  # noqa: S101
        way, depth = -source.side, 0.0
        heading = (float(way), 0.0, 0.0)
        if channel.dodges and source.side > 0:
            depth = channel.depth
            for before, deep in ((DIVE_TO, 0.0), (DIVE_FROM, depth)):
                point = (channel.end - before, deep, source.height)
                start = self._skeleton.extend(start, point, heading)
        stem = []
        for join in range(joins):
            x = channel.trunk - way * (CORNER + LEVEL_STEP * (joins - 1 - join))
            start = self._skeleton.extend(start, (x, depth, source.height), heading)
            stem.append(start)
        return stem, depth

    def _climb(self, start: int, way: int, arm: list[tuple[int, Terminal]]) -> None:
        """Run up (1) or down (-1) along the trunk to the ends of an ``arm``, the nearest first."""
        channel = self._channel
        assert channel.trunk is not None, "there is a trunk to climb"  # noqa: S101
        heading = (0.0, 0.0, float(way))
        height = self._source.height + way * CORNER
        current = self._skeleton.extend(start, (channel.trunk, channel.depth, height), heading)
        place = 0
        while place < len(arm):
            at = arm[place][1].height
            same = [each for each in arm[place:] if abs(each[1].height - at) <= SAME]
            place += len(same)
            joins = len(same) - (place == len(arm))
            for join in range(max(1, joins)):
                below = CORNER + UPRIGHT_STEP * max(0, joins - 1 - join)
                if abs(at - way * below - height) > SAME:
                    height = at - way * below
                    current = self._skeleton.extend(
                        current, (channel.trunk, channel.depth, height), heading
                    )
                self._leave(current, *same[join])
            for number, end in same[max(1, joins) :]:
                self._leave(current, number, end)

    def _leave(self, start: int, number: int, end: Terminal) -> None:
        """Turn from the trunk to one end."""
        channel = self._channel
        assert channel.trunk is not None, "there is a trunk to leave"  # noqa: S101
        in_front = channel.dodges and end.side > 0
        depth = channel.depth if in_front else 0.0
        vertex = self._skeleton.extend(
            start, (channel.trunk + end.side * CORNER, depth, end.height), end.heading
        )
        if in_front:
            for before, deep in ((DIVE_FROM, depth), (DIVE_TO, 0.0)):
                point = (channel.end - before, deep, end.height)
                vertex = self._skeleton.extend(vertex, point, end.heading)
        self._land(vertex, number, end)

    def _land(self, start: int, number: int, end: Terminal) -> None:
        if end.lane != LANE:
            self._lanes.append((number, start))
            return
        point = (float(self._port_xs[end.port]), 0.0, end.height)
        self._skeleton.extend(start, point, end.heading, end.port)
