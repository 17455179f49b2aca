"""The course of one edge of a plan: cubics from one node to the other, soft or strict (Numba).

A soft course is one arch from end to end. The stricter it is, the closer it keeps to its plan: it
rises within a smaller space, keeps to straight lines, and at last goes around what is in its way.
Whatever its strictness, it never leaves its plane once it has risen into it, so that courses in
planes that are far enough apart can meet only where one of them rises.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats
from app.hyperedges.weaving.curvature import bend_between, least_radius
from app.hyperedges.weaving.plan import BEND

SOFT, FLAT, NARROW, STEEP, AROUND = 0, 1, 2, 3, 4
"""How strictly a course keeps to its plan."""

ROOM = 160
"""Cubics that one course may have."""

ARC = 0.5522847498307936
"""Handles of a quarter circle, over its radius."""

BROAD = np.array([0.0, 1.3, 0.7])
"""How broad bends upwards are, over their height, if the course is flat or narrow."""

WIDE = 1.7
"""Radius of the arcs around corners, in radii of the tube, where there is room."""

UPRIGHT = 0.7
"""Directions with a smaller z count as sideways."""

STRAIGHT = 1e-3
"""Turns smaller than this angle are none."""


class End(NamedTuple):
    """Where a course begins or ends: at an attachment, or at a join in the plane.

    ``place`` (3,) and ``direction`` (3,), a unit vector in which the course leaves it; ``foot``
    (2,) and ``lift``: where it is vertical after an attachment, and from which height on.
    """

    is_attachment: bool
    place: Floats
    direction: Floats
    foot: Floats
    lift: float


@njit(cache=True)
def lay_course(
    start: End,
    end: End,
    way: Floats,
    plane: float,
    radius: float,
    strictness: int,
    cubics: Floats,
) -> tuple[int, float]:
    """Cubics from ``start`` to ``end`` along ``way`` (n, 2) at height ``plane``.

    Writes them to ``cubics`` (`ROOM`, 4, 3); returns how many there are, and their least radius of
    curvature over ``radius``.
    """
    if strictness == SOFT and not _turned_away(start, end):
        count = _lay_soft(start, end, plane, radius, cubics)
    elif strictness < STEEP:
        broad = BROAD[max(strictness, FLAT)]
        count = _lay_flat(start, end, plane, radius, broad, cubics)
    else:
        count = _lay_strict(start, end, way, plane, radius, cubics)
    least = np.inf
    for i in range(count):
        least = min(least, least_radius(cubics[i]))
    return count, least / radius


@njit(cache=True)
def _turned_away(start: End, end: End) -> bool:
    """Whether one of two attachments points sideways, and not towards the other."""
    if not (start.is_attachment and end.is_attachment):
        return False
    ahead = 0.0
    behind = 0.0
    for axis in range(2):
        run = end.place[axis] - start.place[axis]
        ahead += start.direction[axis] * run
        behind -= end.direction[axis] * run
    first = start.direction[2] < UPRIGHT and ahead <= 0.0
    second = end.direction[2] < UPRIGHT and behind <= 0.0
    return first or second


@njit(cache=True)
def _lay_soft(start: End, end: End, plane: float, radius: float, cubics: Floats) -> int:
    curve = cubics[0]
    curve[0] = start.place
    curve[3] = end.place
    if start.is_attachment and end.is_attachment:
        _lay_arch(start, end, plane, radius, curve)
    elif start.is_attachment:
        _rise(curve, start.direction, -end.direction, plane, radius)
    elif end.is_attachment:
        cubics[1, 0], cubics[1, 3] = end.place, start.place
        _rise(cubics[1], end.direction, -start.direction, plane, radius)
        for i in range(4):
            curve[i] = cubics[1, 3 - i]
    else:
        bend_between(curve, start.direction, -end.direction, BEND * radius)
    return 1


@njit(cache=True)
def _lay_arch(start: End, end: End, plane: float, radius: float, curve: Floats) -> None:
    """An arch between attachments whose top is at the plane, or lower where it would pinch."""
    span = np.hypot(end.place[0] - start.place[0], end.place[1] - start.place[1])
    middle = (start.place[2] + end.place[2]) / 2.0
    height = (plane - middle) / 0.75
    # The radius at the top of an arch of this span and height is 3/8 span^2 / height.
    height = min(height, 0.375 * span * span / (BEND * radius))
    height = max(height, 1.5 * radius)
    for axis in range(3):
        curve[1, axis] = curve[0, axis] + height * start.direction[axis]
        curve[2, axis] = curve[3, axis] + height * end.direction[axis]


@njit(cache=True)
def _rise(curve: Floats, up: Floats, ahead: Floats, plane: float, radius: float) -> None:
    """From an attachment that is left along ``up`` to a join in the plane that is met ``ahead``."""
    if up[2] < UPRIGHT or plane - curve[0, 2] < radius:
        bend_between(curve, up, ahead, BEND * radius)
        return
    run = np.hypot(curve[3, 0] - curve[0, 0], curve[3, 1] - curve[0, 1])
    rise = (plane - curve[0, 2]) / up[2]
    best, first, second = -1.0, 0.6, 0.55
    for a in (0.6, 0.75, 0.9, 0.45, 1.0):
        for b in (0.55, 0.68, 0.42, 0.8):
            _set_rise(curve, up, ahead, a * rise, b * run)
            least = least_radius(curve)
            if least > best:
                best, first, second = least, a, b
            if best >= BEND * radius:
                return
    _set_rise(curve, up, ahead, first * rise, second * run)


@njit(cache=True)
def _set_rise(curve: Floats, up: Floats, ahead: Floats, first: float, second: float) -> None:
    for axis in range(3):
        curve[1, axis] = curve[0, axis] + first * up[axis]
        curve[2, axis] = curve[3, axis] - second * ahead[axis]


@njit(cache=True)
def _lay_flat(
    start: End, end: End, plane: float, radius: float, broad: float, cubics: Floats
) -> int:
    """Wide bends upwards at attachments, and one curve in the plane between them."""
    length = np.hypot(end.foot[0] - start.foot[0], end.foot[1] - start.foot[1])
    share = 0.5 if start.is_attachment and end.is_attachment else 0.7
    at, ahead = np.empty(3), np.zeros(3)
    back, behind = np.empty(3), np.zeros(3)
    arrival = np.empty((4, 4, 3))
    taken = min(_wide(start, plane, radius, broad), share * length)
    count = _leave(start, end.foot, taken, plane, radius, at, ahead, cubics)
    taken = min(_wide(end, plane, radius, broad), share * length)
    pieces = _leave(end, start.foot, taken, plane, radius, back, behind, arrival)
    count = _go_straight(at, back, ahead, -behind, radius, cubics, count)
    return _arrive(arrival, pieces, cubics, count)


@njit(cache=True)
def _lay_strict(
    start: End, end: End, way: Floats, plane: float, radius: float, cubics: Floats
) -> int:
    """Along straight lines with tight bends, from feet by tight bends upwards."""
    last = len(way) - 1
    tight = BEND * radius
    first_room = np.hypot(way[1, 0] - way[0, 0], way[1, 1] - way[0, 1])
    last_room = np.hypot(way[last, 0] - way[last - 1, 0], way[last, 1] - way[last - 1, 1])
    share = 0.5 if last == 1 else 0.8
    first_taken = min(tight, share * first_room) if start.is_attachment else 0.0
    last_taken = min(tight, share * last_room) if end.is_attachment else 0.0
    at, ahead = np.empty(3), np.zeros(3)
    back, behind = np.empty(3), np.zeros(3)
    arrival = np.empty((4, 4, 3))
    count = _leave(start, way[1], first_taken, plane, radius, at, ahead, cubics)
    pieces = _leave(end, way[last - 1], last_taken, plane, radius, back, behind, arrival)
    for corner in range(1, last):
        before = 0.5 * _length(way, corner - 1)
        after = 0.5 * _length(way, corner)
        if corner == 1:
            before = 2.0 * before - first_taken
        if corner == last - 1:
            after = 2.0 * after - last_taken
        count = _turn_corner(way, corner, before, after, plane, radius, at, ahead, cubics, count)
    count = _go_straight(at, back, ahead, -behind, radius, cubics, count)
    return _arrive(arrival, pieces, cubics, count)


@njit(cache=True)
def _length(way: Floats, leg: int) -> float:
    return float(np.hypot(way[leg + 1, 0] - way[leg, 0], way[leg + 1, 1] - way[leg, 1]))


@njit(cache=True)
def _wide(end: End, plane: float, radius: float, broad: float) -> float:
    """How much room a wide bend from a foot into the plane takes."""
    if not end.is_attachment:
        return 0.0
    # A quarter ellipse, narrower or broader where its ends would pinch.
    rise = plane - end.lift
    tight = BEND * radius
    if rise < tight:
        return tight
    narrowest = max(tight, np.sqrt(tight * rise))
    return float(max(narrowest, min(broad * rise, rise * rise / tight)))


@njit(cache=True)
def _leave(
    end: End,
    there: Floats,
    taken: float,
    plane: float,
    radius: float,
    at: Floats,
    ahead: Floats,
    cubics: Floats,
) -> int:
    """From an end into the plane, ``taken`` towards ``there``; how many cubics that takes.

    Writes where the course is then, and its direction.
    """
    if not end.is_attachment:
        at[:] = end.place
        ahead[:] = end.direction
        return 0
    length = np.hypot(there[0] - end.foot[0], there[1] - end.foot[1])
    if length > 0.0:
        ahead[0], ahead[1] = (there[0] - end.foot[0]) / length, (there[1] - end.foot[1]) / length
    else:
        ahead[0], ahead[1] = 1.0, 0.0
    ahead[2] = 0.0
    at[0], at[1] = end.foot[0] + taken * ahead[0], end.foot[1] + taken * ahead[1]
    at[2] = plane
    return _climb(end, taken, plane, radius, at, ahead, cubics)


@njit(cache=True)
def _climb(
    end: End, taken: float, plane: float, radius: float, at: Floats, ahead: Floats, cubics: Floats
) -> int:
    count = 0
    low = np.empty(3)
    low[:] = end.place
    if end.lift != end.place[2] or end.foot[0] != low[0] or end.foot[1] != low[1]:
        cubics[0, 0] = end.place
        cubics[0, 3, 0], cubics[0, 3, 1], cubics[0, 3, 2] = end.foot[0], end.foot[1], end.lift
        _turn_up(cubics[0], end.direction)
        low[:] = cubics[0, 3]
        count = 1
    bend = plane - low[2]
    if bend < radius:
        # A plane so low, or lower than that, was asked for: up, and down again.
        cubics[count, 0] = low
        cubics[count, 3] = at
        bend_between(cubics[count], np.array([0.0, 0.0, 1.0]), ahead, BEND * radius)
        return count + 1
    if taken <= 1.01 * BEND * radius and bend > 1.2 * BEND * radius:
        # A tight bend is a quarter circle at the top of a straight riser.
        straight = bend - BEND * radius
        cubics[count, 0] = low
        for i in range(1, 4):
            cubics[count, i] = low
            cubics[count, i, 2] = low[2] + straight * i / 3.0
        low[:] = cubics[count, 3]
        bend = plane - low[2]
        count += 1
    cubics[count, 0] = low
    cubics[count, 1] = low
    cubics[count, 1, 2] = low[2] + ARC * bend
    for axis in range(3):
        cubics[count, 2, axis] = at[axis] - ARC * taken * ahead[axis]
    cubics[count, 3] = at
    return count + 1


@njit(cache=True)
def _turn_up(curve: Floats, direction: Floats) -> None:
    """The arc from an attachment's direction to upright, between the ends of ``curve``."""
    turn = np.arccos(min(max(direction[2], -1.0), 1.0))
    chord = 0.0
    for axis in range(3):
        chord += (curve[3, axis] - curve[0, axis]) ** 2
    handle = 2.0 / 3.0 * np.tan(turn / 4.0) / np.sin(turn / 2.0) * np.sqrt(chord)
    for axis in range(3):
        curve[1, axis] = curve[0, axis] + handle * direction[axis]
        curve[2, axis] = curve[3, axis]
    curve[2, 2] -= handle


@njit(cache=True)
def _go_straight(
    at: Floats,
    to: Floats,
    ahead: Floats,
    arriving: Floats,
    radius: float,
    cubics: Floats,
    count: int,
) -> int:
    """Lay what is left between two places, if they are apart; how many cubics there are."""
    x, y = to[0] - at[0], to[1] - at[1]
    if np.hypot(x, y) <= 1e-6 * radius:
        if count > 0:
            cubics[count - 1, 3] = to
        return count
    cubics[count, 0] = at
    cubics[count, 3] = to
    bend_between(cubics[count], ahead, arriving, BEND * radius)
    return count + 1


@njit(cache=True)
def _arrive(arrival: Floats, pieces: int, cubics: Floats, count: int) -> int:
    """Append what was laid from the end, turned around."""
    for piece in range(pieces - 1, -1, -1):
        for i in range(4):
            cubics[count, i] = arrival[piece, 3 - i]
        count += 1
    return count


@njit(cache=True)
def _turn_corner(
    way: Floats,
    corner: int,
    before: float,
    after: float,
    plane: float,
    radius: float,
    at: Floats,
    ahead: Floats,
    cubics: Floats,
    count: int,
) -> int:
    """Lay what leads to a corner of the way and the arc around it; how many cubics there are.

    The arc may take up to ``before`` and ``after`` of the legs beside the corner.
    """
    length = _length(way, corner - 1)
    ux = (way[corner, 0] - way[corner - 1, 0]) / length
    uy = (way[corner, 1] - way[corner - 1, 1]) / length
    length = _length(way, corner)
    vx = (way[corner + 1, 0] - way[corner, 0]) / length
    vy = (way[corner + 1, 1] - way[corner, 1]) / length
    turn = abs(np.arctan2(ux * vy - uy * vx, ux * vx + uy * vy))
    if turn < STRAIGHT:
        return count
    half = np.tan(turn / 2.0)
    cut = min(WIDE * radius * half, before, after)
    last = np.array([way[corner, 0] - cut * ux, way[corner, 1] - cut * uy, plane])
    straight = np.array([ux, uy, 0.0])
    count = _go_straight(at, last, ahead, straight, radius, cubics, count)
    handle = 4.0 / 3.0 * np.tan(turn / 4.0) * cut / half
    curve = cubics[count]
    curve[0] = last
    at[0], at[1], at[2] = way[corner, 0] + cut * vx, way[corner, 1] + cut * vy, plane
    curve[1, 0], curve[1, 1], curve[1, 2] = last[0] + handle * ux, last[1] + handle * uy, plane
    curve[2, 0], curve[2, 1], curve[2, 2] = at[0] - handle * vx, at[1] - handle * vy, plane
    curve[3] = at
    ahead[0], ahead[1], ahead[2] = vx, vy, 0.0
    return count + 1
