"""The paper's text, followed word by word: cubic search, recursion, one point after another.

Independent of the code under test, and slow. Points are named by position in the working list, so
that coincident ones are not lost; a join is appended to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.arrays import Floats


@dataclass(frozen=True, eq=False)
class ConnectionPoint:
    name: int
    position: Floats
    following: Floats | None = None


@dataclass(frozen=True, eq=False)
class Curve:
    control_points: Floats
    ends: tuple[int, int]


def centroid(*points: Floats) -> Floats:
    return np.asarray(sum(points, np.zeros(3)) / len(points))


def joinplane_shift(point: Floats, joinplane: float) -> Floats:
    return np.array([point[0], point[1], joinplane])


def closest(points: list[ConnectionPoint], dimensions: int) -> tuple[int, int]:
    pairs = [(a, b) for a in range(len(points)) for b in range(a + 1, len(points))]

    def distance(pair: tuple[int, int]) -> float:
        a, b = (points[place].position[:dimensions] for place in pair)
        return float(((a - b) ** 2).sum())

    return min(pairs, key=distance)  # the first of equals, which has the smallest numbers


def curves(
    positions: Floats,
    joinplane: float,
    reading: Literal["prose", "symbolic"],
    dimensions: int = 3,
) -> list[Curve]:
    points = [ConnectionPoint(name, position) for name, position in enumerate(positions)]
    return _curves(points, joinplane, reading, dimensions, len(points))


def _curves(
    points: list[ConnectionPoint],
    joinplane: float,
    reading: Literal["prose", "symbolic"],
    dimensions: int,
    next_name: int,
) -> list[Curve]:
    if len(points) == 2:
        return [_last_curve(points[0], points[1], joinplane)]
    a, b = closest(points, dimensions)
    a1, a2 = points[a], points[b]
    rest = [point for place, point in enumerate(points) if place not in (a, b)]
    c = centroid(*(point.position for point in rest))
    m = joinplane_shift(centroid(a1.position, a2.position, c), joinplane)
    third = c if reading == "symbolic" else centroid(m, a1.position, a2.position)
    made = []
    for point in (a1, a2):
        interior = point.following if point.following is not None else centroid(point.position, m)
        control_points = np.array([point.position, interior, third, m])
        made.append(Curve(control_points, (point.name, next_name)))
    join = ConnectionPoint(next_name, m, m + (m - third))
    return made + _curves([*rest, join], joinplane, reading, dimensions, next_name + 1)


def _last_curve(p1: ConnectionPoint, p2: ConnectionPoint, joinplane: float) -> Curve:
    if p1.following is None and p2.following is not None:
        p1, p2 = p2, p1
    if p1.following is not None and p2.following is not None:
        interior = (p1.following, p2.following)
    elif p1.following is not None:
        interior = (p1.following, centroid(p1.following, p2.position))
    else:
        thirds = (p2.position - p1.position) / 3
        interior = (
            joinplane_shift(p1.position + thirds, joinplane),
            joinplane_shift(p1.position + 2 * thirds, joinplane),
        )
    control_points = np.array([p1.position, *interior, p2.position])
    return Curve(control_points, (p1.name, p2.name))
