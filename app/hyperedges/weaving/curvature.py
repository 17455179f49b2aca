"""Cubic Bezier curves that a tube can follow (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats

PLACES = 24
"""Places along a curve at which its curvature is looked at."""

HANDLES = np.array([0.38, 0.3, 0.46, 0.55, 0.24, 0.65, 0.8])
"""Lengths of handles to choose from, over the distance of the ends; the first are tried first."""


@njit(cache=True)
def least_radius(curve: Floats) -> float:
    """The least radius of curvature of a cubic (4, 3), infinite for a straight line.

    Curvature is |B' x B''| over |B'| cubed, at `PLACES` + 1 places.
    """
    a0, a1, a2 = curve[1, 0] - curve[0, 0], curve[1, 1] - curve[0, 1], curve[1, 2] - curve[0, 2]
    b0, b1, b2 = curve[2, 0] - curve[1, 0], curve[2, 1] - curve[1, 1], curve[2, 2] - curve[1, 2]
    c0, c1, c2 = curve[3, 0] - curve[2, 0], curve[3, 1] - curve[2, 1], curve[3, 2] - curve[2, 2]
    largest = 0.0
    for i in range(PLACES + 1):
        t = i / PLACES
        s = 1.0 - t
        u, v, w = s * s, 2.0 * s * t, t * t
        x, y, z = u * a0 + v * b0 + w * c0, u * a1 + v * b1 + w * c1, u * a2 + v * b2 + w * c2
        dx = s * (b0 - a0) + t * (c0 - b0)
        dy = s * (b1 - a1) + t * (c1 - b1)
        dz = s * (b2 - a2) + t * (c2 - b2)
        square = x * x + y * y + z * z
        if square <= 0.0:
            return 0.0
        nx, ny, nz = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
        bend = (nx * nx + ny * ny + nz * nz) / (square * square * square)
        largest = max(largest, bend)
    # B' is three times these differences, B'' six times theirs: 6 * 3 / 3 ** 3 = 2 / 3.
    return 1.5 / np.sqrt(largest) if largest > 0.0 else np.inf


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
