"""Short ways in the plane around discs (Numba).

A way bends at the corners of octagons around discs. Only discs that are in the way are looked at:
the shortest way around those found so far is tried against all others, and what it hits is added
until it hits nothing. As discs only make ways longer, the way that hits nothing is the shortest.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices

SIDES = 8

MOST = 48
"""So many discs may be in the way of one edge."""

MOST_CORNERS = SIDES * MOST

CORNER = 0.3
"""What a corner costs, over the radius of arcs."""

CRAMPED = 8.0
"""What a way costs more for each unit of length that arcs lack at its corners."""

APPROACH = 1.25
"""Length of the leg before a and after b, over the radius of arcs."""

SHARP = 0.9 * np.pi
"""Sharper turns than this count as this."""

OUT = 1.01 / np.cos(np.pi / SIDES)
"""Corners of the octagons, over the radius of their discs: a little outside of them."""


@njit(cache=True)
def find_way(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    discs: Floats,
    headings: Floats,
    bend: float,
    way: Floats,
) -> int:
    """A short way from a to b around ``discs`` (m, 3), given as x, y and radius.

    ``headings`` (2, 2) are the directions in which the way comes to a and goes on from b, zero
    where it does not matter. Arcs of radius ``bend`` shall fit into its corners. Writes the corners
    to ``way`` (n, 2) and returns how many there are, or -1 if there is no way. Neither end may lie
    within a disc.
    """
    way[0, 0], way[0, 1] = ax, ay
    way[1, 0], way[1, 1] = bx, by
    corners = 0
    used = np.empty(MOST, np.int64)
    is_used = np.zeros(len(discs), np.bool_)
    count = 0
    for _ in range(MOST):
        before = count
        for leg in range(corners + 1):
            for i in range(len(discs)):
                if not is_used[i] and _hits(
                    way[leg, 0], way[leg, 1], way[leg + 1, 0], way[leg + 1, 1], discs[i]
                ):
                    if count == MOST:
                        return -1
                    is_used[i] = True
                    used[count] = i
                    count += 1
        if count == before:
            return corners
        corners = _around(ax, ay, bx, by, discs, used[:count], headings, bend, way)
        if corners < 0:
            return -1
    return -1


@njit(cache=True)
def _hits(ax: float, ay: float, bx: float, by: float, disc: Floats) -> bool:
    x, y = bx - ax, by - ay
    square = x * x + y * y
    t = 0.0
    if square > 0.0:
        t = min(max(((disc[0] - ax) * x + (disc[1] - ay) * y) / square, 0.0), 1.0)
    dx, dy = ax + t * x - disc[0], ay + t * y - disc[1]
    return bool(dx * dx + dy * dy < disc[2] * disc[2])


@njit(cache=True)
def _around(
    ax: float,
    ay: float,
    bx: float,
    by: float,
    discs: Floats,
    used: Indices,
    headings: Floats,
    bend: float,
    way: Floats,
) -> int:
    """The shortest way around the discs ``used``, by A* over their corners."""
    spots = np.empty((2 + SIDES * len(used), 2))
    spots[0, 0], spots[0, 1] = ax, ay
    spots[1, 0], spots[1, 1] = bx, by
    count = _add_corners(discs, used, np.arctan2(by - ay, bx - ax), spots)
    cost = np.full(count, np.inf)
    before = np.full(count, -1)
    done = np.zeros(count, np.bool_)
    # How much of the leg towards each spot the arc at its start takes.
    taken = np.zeros(count)
    cost[0] = 0.0
    while True:
        at = _cheapest(spots, cost, done, count)
        if at < 0:
            return -1
        if at == 1:
            break
        done[at] = True
        in_x, in_y, room = headings[0, 0], headings[0, 1], APPROACH * bend
        if at > 0:
            in_x = spots[at, 0] - spots[before[at], 0]
            in_y = spots[at, 1] - spots[before[at], 1]
            room = np.hypot(in_x, in_y) - taken[at]
        for to in range(1, count):
            if done[to]:
                continue
            x, y = spots[to, 0] - spots[at, 0], spots[to, 1] - spots[at, 1]
            length = np.hypot(x, y)
            if cost[at] + length + CORNER * bend >= cost[to]:
                continue
            cut = _cut(in_x, in_y, x, y, bend)
            lacking = max(0.0, cut - room) + max(0.0, cut - 0.6 * length)
            if to == 1:
                last = _cut(x, y, headings[1, 0], headings[1, 1], bend)
                lacking += max(0.0, last - APPROACH * bend) + max(0.0, last + cut - length)
            total = cost[at] + length + CORNER * bend + CRAMPED * lacking
            if total < cost[to] and _free(spots[at], spots[to], discs, used):
                cost[to], before[to], taken[to] = total, at, cut
    return _write_way(spots, before, way)


@njit(cache=True)
def _add_corners(discs: Floats, used: Indices, heading: float, spots: Floats) -> int:
    """Write the corners around discs that no other disc covers after the two ends."""
    count = 2
    for i in used:
        for side in range(SIDES):
            angle = heading + 2.0 * np.pi * (side + 0.5) / SIDES
            x = discs[i, 0] + discs[i, 2] * OUT * np.cos(angle)
            y = discs[i, 1] + discs[i, 2] * OUT * np.sin(angle)
            free = True
            for j in used:
                dx, dy = x - discs[j, 0], y - discs[j, 1]
                if dx * dx + dy * dy < discs[j, 2] * discs[j, 2]:
                    free = False
                    break
            if free:
                spots[count, 0], spots[count, 1] = x, y
                count += 1
    return count


@njit(cache=True)
def _cut(ax: float, ay: float, bx: float, by: float, bend: float) -> float:
    """How much of both legs an arc of radius ``bend`` takes between directions a and b."""
    turn = abs(np.arctan2(ax * by - ay * bx, ax * bx + ay * by))
    return float(bend * np.tan(min(turn, SHARP) / 2.0))


@njit(cache=True)
def _cheapest(spots: Floats, cost: Floats, done: NDArray[np.bool_], count: int) -> int:
    best, at = np.inf, -1
    for i in range(count):
        if not done[i] and cost[i] < np.inf:
            total = cost[i] + np.hypot(spots[i, 0] - spots[1, 0], spots[i, 1] - spots[1, 1])
            if total < best:
                best, at = total, i
    return at


@njit(cache=True)
def _free(a: Floats, b: Floats, discs: Floats, used: Indices) -> bool:
    for i in used:  # noqa: SIM110 (Numba has no generators)
        if _hits(a[0], a[1], b[0], b[1], discs[i]):
            return False
    return True


@njit(cache=True)
def _write_way(spots: Floats, before: Indices, way: Floats) -> int:
    corners = 0
    at = before[1]
    while at > 0:
        corners += 1
        at = before[at]
    if corners + 2 > len(way):
        return -1
    way[corners + 1] = spots[1]
    at = before[1]
    for place in range(corners, -1, -1):
        way[place] = spots[at]
        at = before[at]
    return corners
