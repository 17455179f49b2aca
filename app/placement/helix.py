"""Items on a helix around an upright axis, each turned to face outward."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from app.placement.turning import UNTURNED, Quaternion, Vector, from_degrees, then, turned
from app.program.model import Helix

USUAL = 8
"""Items of one turn, where nobody says how many."""

SLACK = 1e-9
"""Share by which what just fits may be too large."""


@dataclass(frozen=True, slots=True)
class Bulk:
    """An upright cylinder around an item's centre that holds it, however it is turned about z."""

    radius: float
    height: float

    @staticmethod
    def of(size: Vector, center: Vector, turn: Quaternion) -> Bulk:
        """Of a box of ``size`` about ``center``, turned.

        >>> Bulk.of((6.0, 8.0, 1.0), (0.0, 0.0, 0.0), UNTURNED)
        Bulk(radius=5.0, height=1.0)
        """
        x, y, z = center
        a, b, c = (length / 2 for length in size)
        corners = [
            turned(turn, (x + i * a, y + j * b, z + k * c))
            for i in (-1, 1)
            for j in (-1, 1)
            for k in (-1, 1)
        ]
        radius = max(math.hypot(corner[0], corner[1]) for corner in corners)
        return Bulk(radius, 2 * max(abs(corner[2]) for corner in corners))


@dataclass(frozen=True, slots=True)
class Wound:
    """Where items are on a helix, from the foot of its axis, and how each is turned there.

    ``reach`` is the radius of the upright cylinder around all.
    """

    centers: tuple[Vector, ...]
    turns: tuple[Quaternion, ...]
    reach: float


def leaning(helix: Helix) -> Quaternion:
    """How an item leans before it is turned about the axis: its top away from that."""
    return from_degrees(helix.tilt, 0.0, 0.0) if helix.rotate and helix.tilt else UNTURNED


def wind(helix: Helix, bulks: Sequence[Bulk], gap: float) -> Wound:
    """Items of ``bulks``, in their order, ``gap`` apart where the helix leaves that open.

    Numbers that it gives are obeyed, whether items then overlap or not.
    """
    needed = 2 * max(bulk.radius for bulk in bulks) + gap
    tallest = max(bulk.height for bulk in bulks)
    count = helix.items_per_turn or _count(helix, len(bulks), needed)
    radius = helix.radius or _radius(helix, len(bulks), count, needed, tallest + gap)
    pitch = helix.pitch or _pitch(len(bulks), count, radius, needed, tallest + gap)
    centers: list[Vector] = []
    turns: list[Quaternion] = []
    for number in range(len(bulks)):
        turn = (-1 if helix.clockwise else 1) * math.remainder(number / count, 1.0) * 360.0
        angle = helix.start + turn
        spin = from_degrees(0.0, 0.0, angle)
        x, y, _ = turned(spin, (0.0, -radius, 0.0))
        centers.append((x, y, tallest / 2 + pitch * number / count))
        turns.append(then(spin, leaning(helix)) if helix.rotate else UNTURNED)
    return Wound(tuple(centers), tuple(turns), radius + (needed - gap) / 2)


def _count(helix: Helix, items: int, needed: float) -> float:
    """Items of one turn: as many as fit around the radius given, else what is usual."""
    if helix.radius is not None:
        share = needed / (2 * helix.radius)
        fitting = math.floor(math.pi / math.asin(share) * (1 + SLACK)) if share <= 1 else 0
        return min(fitting, items) if fitting >= 3 else USUAL
    # A pitch that is given may be too low for one turn to pass over another.
    return items if helix.pitch is not None else min(items, USUAL)


def _radius(helix: Helix, items: int, count: float, needed: float, rise: float) -> float:
    """The smallest with ``needed`` between items of one turn, unless ``rise`` is between them."""
    last = _around(count) - 1
    if helix.pitch is not None:
        last = min(last, math.ceil(rise * count / helix.pitch) - 1)
    last = min(last, items - 1)
    if last < 1:
        return needed
    narrowest = min(math.sin(math.pi / count), math.sin(math.pi * last / count))
    return needed / (2 * narrowest)


def _pitch(items: int, count: float, radius: float, needed: float, rise: float) -> float:
    """The lowest with ``rise`` between items that are less than ``needed`` apart sideways."""
    for step in range(1, min(items, _around(count) + 1)):
        if 2 * radius * abs(math.sin(math.pi * step / count)) < needed * (1 - SLACK):
            return rise * count / step
    return rise


def _around(count: float) -> int:
    """How many items farther one stands about above another, of ``count`` in one turn."""
    return max(1, math.ceil(count - 0.5))
