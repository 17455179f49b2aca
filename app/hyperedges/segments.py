"""One step of CURVES: the segments that it makes, and the join with its tangent (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices

ROUNDING = 8 * np.finfo(np.float64).eps
"""Vectors shorter than this share of their ends' coordinates have no direction."""


class Curves(NamedTuple):
    """Curves of one or more hyperedges, one after another.

    ``control_points`` (s, 4, 3); ``ends`` (s, 2), ``joins`` (j, 3) and unit ``tangents`` (j, 3) as
    `app.hyperedges.routing.Routing` has them.
    """

    control_points: Floats
    ends: Indices
    joins: Floats
    tangents: Floats


class Rules(NamedTuple):
    """What is chosen about CURVES: the reading, the fidelity, and how CLOSEST measures."""

    prose: bool
    square: bool
    dimensions: int
    directly: bool


class Points(NamedTuple):
    """The connection points of one hyperedge: its ``number`` attachments first, then its joins.

    ``positions`` and ``following`` (n, 3), the latter for joins only; unit ``directions``
    (``number``, 3) of the attachments.
    """

    positions: Floats
    following: Floats
    directions: Floats
    number: int


@njit(cache=True)
def normal(coordinate: float) -> float:
    """The coordinate, or zero where it is so small that its square could vanish.

    Otherwise points could be apart and yet at no distance. Makes -0.0 to 0.0, too.
    """
    return coordinate if abs(coordinate) > 1e-130 else 0.0


@njit(cache=True)
def join_two(
    points: Points,
    first: int,
    second: int,
    join: int,
    centroid: Floats,
    plane: float,
    rules: Rules,
    curves: Curves,
    segment: int,
    row: int,
) -> None:
    """Join two connection points in a new one, numbered ``join``.

    ``centroid`` (3,) is that of the others. Writes segments ``segment`` and the next, and row
    ``row`` of the joins.
    """
    at, following = points.positions, points.following
    for axis in range(3):
        middle = (at[first, axis] + at[second, axis] + centroid[axis]) / 3.0
        middle = normal(middle if axis < 2 else plane)
        entering = centroid[axis]
        if rules.prose:
            entering = (middle + at[first, axis] + at[second, axis]) / 3.0
        at[join, axis] = middle
        following[join, axis] = middle + (middle - entering)
        curves.joins[row, axis] = middle
        for side in range(2):
            end = first if side == 0 else second
            interior = (at[end, axis] + middle) / 2.0
            if end >= points.number:
                interior = following[end, axis]
            curves.control_points[segment + side, 0, axis] = at[end, axis]
            curves.control_points[segment + side, 1, axis] = interior
            curves.control_points[segment + side, 2, axis] = entering
            curves.control_points[segment + side, 3, axis] = middle
    for side in range(2):
        end = first if side == 0 else second
        curves.ends[segment + side, 0] = end
        curves.ends[segment + side, 1] = join
        if rules.square and end < points.number:
            _turn_square(curves.control_points[segment + side], 0, 1, points.directions[end])
    _set_tangent(points, first, second, join, centroid, curves.tangents[row])


@njit(cache=True)
def join_last(
    points: Points,
    first: int,
    second: int,
    plane: float,
    rules: Rules,
    curves: Curves,
    segment: int,
) -> None:
    """Write the segment between the last two connection points, which begins at a join if any."""
    at, following, count = points.positions, points.following, points.number
    if first < count <= second:
        first, second = second, first
    control_points = curves.control_points[segment]
    for axis in range(3):
        one, other = at[first, axis], at[second, axis]
        control_points[0, axis] = one
        control_points[3, axis] = other
        if second >= count:
            control_points[1, axis] = following[first, axis]
            control_points[2, axis] = following[second, axis]
        elif first >= count:
            control_points[1, axis] = following[first, axis]
            control_points[2, axis] = (following[first, axis] + other) / 2.0
        else:
            control_points[1, axis] = one + (other - one) / 3.0 if axis < 2 else plane
            control_points[2, axis] = other + (one - other) / 3.0 if axis < 2 else plane
    curves.ends[segment, 0] = first
    curves.ends[segment, 1] = second
    if rules.square and first < count:
        _turn_square(control_points, 0, 1, points.directions[first])
    if rules.square and second < count:
        _turn_square(control_points, 3, 2, points.directions[second])


@njit(cache=True)
def _turn_square(control_points: Floats, end: int, interior: int, direction: Floats) -> None:
    """Turn an interior control point about its end until it lies along ``direction``."""
    length = 0.0
    for axis in range(3):
        length += (control_points[interior, axis] - control_points[end, axis]) ** 2
    length = np.sqrt(length)
    for axis in range(3):
        control_points[interior, axis] = control_points[end, axis] + length * direction[axis]


@njit(cache=True)
def _set_tangent(
    points: Points, first: int, second: int, join: int, centroid: Floats, tangent: Floats
) -> None:
    """Write the unit vector from a join towards its following point.

    Where the two coincide the curves have no common tangent, and the first of these that has a
    length stands in: onwards from the middle of the two points joined; from one to the other, for
    they then meet head on; towards the centroid of the others; x.
    """
    at = points.positions
    scale = 0.0
    for axis in range(3):
        scale = max(scale, abs(at[first, axis]), abs(at[second, axis]), abs(at[join, axis]))
        scale = max(scale, abs(centroid[axis]))
    for attempt in range(4):
        length = 0.0
        for axis in range(3):
            if attempt == 0:
                tangent[axis] = points.following[join, axis] - at[join, axis]
            elif attempt == 1:
                tangent[axis] = 2.0 * at[join, axis] - at[first, axis] - at[second, axis]
            elif attempt == 2:
                tangent[axis] = at[second, axis] - at[first, axis]
            else:
                tangent[axis] = centroid[axis] - at[join, axis]
            length += tangent[axis] ** 2
        length = np.sqrt(length)
        if length > ROUNDING * scale:
            for axis in range(3):
                tangent[axis] /= length
            return
    tangent[0], tangent[1], tangent[2] = 1.0, 0.0, 0.0
