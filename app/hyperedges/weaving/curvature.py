"""Cubic Bezier curves that a tube can follow (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats

PLACES = 24
"""Places along a curve at which its curvature is looked at."""

CLOSER = 5
"""Into so many parts the stretches beside the tightest place are divided."""

TIMES = 2
"""How often they are."""

NEARLY = 0.4
"""Squared curvatures over the largest: such peaks may be the higher ones, between two places."""

HANDLES = np.array([0.38, 0.3, 0.46, 0.55, 0.24, 0.65, 0.8])
"""Lengths of handles to choose from, over the distance of the ends; the first are tried first."""


@njit(cache=True)
def least_radius(curve: Floats) -> float:
    """The least radius of curvature of a cubic (4, 3), infinite for a straight line.

    It is looked for at `PLACES` + 1 places, then between those beside the tightest, and beside any
    other place where the curve is tighter than on both sides, and nearly as tight as there.
    """
    largest, tightest = 0.0, 0
    x = y = z = 0.0
    bends = np.empty(PLACES + 1)
    for i in range(PLACES + 1):
        bends[i] = _squared_bend(curve, i / PLACES)
        if bends[i] > largest:
            largest, tightest = bends[i], i
        before_x, before_y, before_z = x, y, z
        x, y, z = _velocity(curve, i / PLACES)
        if x * before_x + y * before_y + z * before_z < 0.0:
            # More than a right angle between two places: it turns on the spot.
            return 0.0
    nearly = NEARLY * largest
    for i in range(PLACES + 1):
        is_peak = (i == 0 or bends[i] >= bends[i - 1]) and (i == PLACES or bends[i] >= bends[i + 1])
        if i != tightest and not (is_peak and bends[i] > nearly):
            continue
        middle, step, highest = i / PLACES, 1.0 / PLACES, bends[i]
        for _ in range(TIMES):
            step /= CLOSER
            best = middle
            for k in range(-CLOSER + 1, CLOSER):
                t = min(max(middle + k * step, 0.0), 1.0)
                bend = _squared_bend(curve, t)
                if bend > highest:
                    highest, best = bend, t
            middle = best
        largest = max(largest, highest)
    return 1.0 / np.sqrt(largest) if largest > 0.0 else np.inf


@njit(cache=True)
def _velocity(curve: Floats, t: float) -> tuple[float, float, float]:
    """A third of B' at t."""
    s = 1.0 - t
    u, v, w = s * s, 2.0 * s * t, t * t
    return (
        u * (curve[1, 0] - curve[0, 0])
        + v * (curve[2, 0] - curve[1, 0])
        + w * (curve[3, 0] - curve[2, 0]),
        u * (curve[1, 1] - curve[0, 1])
        + v * (curve[2, 1] - curve[1, 1])
        + w * (curve[3, 1] - curve[2, 1]),
        u * (curve[1, 2] - curve[0, 2])
        + v * (curve[2, 2] - curve[1, 2])
        + w * (curve[3, 2] - curve[2, 2]),
    )


@njit(cache=True)
def _squared_bend(curve: Floats, t: float) -> float:
    """The square of the curvature at t: of |B' x B''| over |B'| cubed."""
    s = 1.0 - t
    x = y = z = dx = dy = dz = 0.0
    for i in range(3):
        weight = s * s if i == 0 else (2.0 * s * t if i == 1 else t * t)
        change = -s if i == 0 else (s - t if i == 1 else t)
        a, b = curve[i + 1, 0] - curve[i, 0], curve[i + 1, 1] - curve[i, 1]
        c = curve[i + 1, 2] - curve[i, 2]
        x, y, z = x + weight * a, y + weight * b, z + weight * c
        dx, dy, dz = dx + change * a, dy + change * b, dz + change * c
    square = x * x + y * y + z * z
    cube = square * square * square
    if cube <= 0.0:
        return np.inf
    nx, ny, nz = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
    # B' is three times (x, y, z), B'' six times (dx, dy, dz): 6 * 3 / 3 ** 3 = 2 / 3.
    return float(4.0 / 9.0 * (nx * nx + ny * ny + nz * nz) / cube)


@njit(cache=True)
def bend_between(curve: Floats, start: Floats, end: Floats, needed: float) -> float:
    """Set the inner control points of a cubic so that it bends gently; its least radius.

    ``curve`` (4, 3) has its ends; ``start`` and ``end`` (3,) are unit tangents there. The first
    handles with a radius of ``needed`` are taken, or those with the largest radius.
    """
    x, y, z = curve[3, 0] - curve[0, 0], curve[3, 1] - curve[0, 1], curve[3, 2] - curve[0, 2]
    chord = np.sqrt(x * x + y * y + z * z)
    best, first, second = -1.0, HANDLES[0], HANDLES[0]
    for i in range(len(HANDLES)):
        for j in range(i + 1):
            for swap in range(2 if j < i else 1):
                a, b = (HANDLES[i], HANDLES[j]) if swap == 0 else (HANDLES[j], HANDLES[i])
                _set_handles(curve, start, end, a * chord, b * chord)
                radius = least_radius(curve)
                if radius > best:
                    best, first, second = radius, a, b
                if best >= needed:
                    return best
    _set_handles(curve, start, end, first * chord, second * chord)
    return best


@njit(cache=True)
def _set_handles(curve: Floats, start: Floats, end: Floats, first: float, second: float) -> None:
    for axis in range(3):
        curve[1, axis] = curve[0, axis] + first * start[axis]
        curve[2, axis] = curve[3, axis] - second * end[axis]
