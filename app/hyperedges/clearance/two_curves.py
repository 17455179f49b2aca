"""A row of two pieces of curves: how far they are from each other at least (Numba).

The nearest points of the two chords give a direction. Along it the one piece lies beyond a bound
and the other before one (`app.hyperedges.clearance.cubic`), and the room between is a lower bound
of their distance, whatever the direction: a poor one costs time, never the truth.

Columns 0 to 11 and 12 to 23 are the cubics, 24 to 27 from where to where they are on their curves.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from app.arrays import Floats
from app.hyperedges.clearance.cubic import SLACK, copy, halve, lowest, point, spread

COLUMNS = 28


@njit(cache=True, error_model="numpy")
def place_curves(p: Floats, q: Floats, rows: Floats) -> float:
    """Write both curves to row 0, about their middle; the power of two they are divided by."""
    extent = 0.0
    for axis in range(3):
        low = high = p[0, axis]
        for k in range(4):
            low = min(low, p[k, axis], q[k, axis])
            high = max(high, p[k, axis], q[k, axis])
        middle = low + 0.5 * (high - low)
        for k in range(4):
            rows[0, 3 * k + axis] = p[k, axis] - middle
            rows[0, 12 + 3 * k + axis] = q[k, axis] - middle
        extent = max(extent, high - low)
    scale = math.ldexp(1.0, math.frexp(extent)[1]) if extent > 0.0 else 1.0
    for column in range(24):
        rows[0, column] /= scale
    rows[0, 24], rows[0, 25], rows[0, 26], rows[0, 27] = 0.0, 1.0, 0.0, 1.0
    return scale


@njit(cache=True, error_model="numpy")
def halve_either(rows: Floats, row: int, new: int) -> None:
    """Halve that curve of a row that leaves its chord farther; the second half goes to ``new``."""
    copy(rows, row, new, 0, COLUMNS)
    column, parameter = (0, 24) if spread(rows, row, 0) >= spread(rows, row, 12) else (12, 26)
    halve(rows, row, new, column)
    middle = 0.5 * (rows[row, parameter] + rows[row, parameter + 1])
    rows[row, parameter + 1] = middle
    rows[new, parameter] = middle


@njit(cache=True, error_model="numpy")
def look_at_curves(rows: Floats, row: int, upper: float) -> tuple[float, float, float, float]:
    """A lower bound, an upper bound and where it is, for the two pieces of a row."""
    s, t = _nearest(rows, row)
    x = _along(rows, row, 0, s) - _along(rows, row, 12, t)
    y = _along(rows, row, 1, s) - _along(rows, row, 13, t)
    z = _along(rows, row, 2, s) - _along(rows, row, 14, t)
    length = math.sqrt(x * x + y * y + z * z)
    if length > 1e-9:
        x, y, z = x / length, y / length, z / length
        key = lowest(rows, row, 0, x, y, z) + lowest(rows, row, 12, -x, -y, -z) - SLACK
        if key >= upper:
            return key, np.inf, 0.0, 0.0
    else:
        key = -spread(rows, row, 0) - spread(rows, row, 12) - SLACK
    a, b, c = point(rows, row, 0, s)
    d, e, f = point(rows, row, 12, t)
    here = math.sqrt((a - d) ** 2 + (b - e) ** 2 + (c - f) ** 2) + SLACK
    u = rows[row, 24] + s * (rows[row, 25] - rows[row, 24])
    v = rows[row, 26] + t * (rows[row, 27] - rows[row, 26])
    return key, here, u, v


@njit(cache=True, error_model="numpy", inline="always")
def _along(rows: Floats, row: int, column: int, t: float) -> float:
    return float(rows[row, column] + t * (rows[row, column + 9] - rows[row, column]))


@njit(cache=True, error_model="numpy")
def _nearest(rows: Floats, row: int) -> tuple[float, float]:
    """Where the chords of a row's two pieces are nearest to each other.

    Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    uu, vv, uv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        u = rows[row, axis + 9] - rows[row, axis]
        v = rows[row, axis + 21] - rows[row, axis + 12]
        w = rows[row, axis] - rows[row, axis + 12]
        uu += u * u
        vv += v * v
        uv += u * v
        uw += u * w
        vw += v * w
    if vv <= 0.0:
        return (min(max(-uw / uu, 0.0), 1.0) if uu > 0.0 else 0.0), 0.0
    if uu <= 0.0:
        return 0.0, min(max(vw / vv, 0.0), 1.0)
    size = uu * vv - uv * uv
    s = min(max((uv * vw - uw * vv) / size, 0.0), 1.0) if size > 1e-14 * uu * vv else 0.5
    t = (uv * s + vw) / vv
    if t < 0.0:
        return min(max(-uw / uu, 0.0), 1.0), 0.0
    if t > 1.0:
        return min(max((uv - uw) / uu, 0.0), 1.0), 1.0
    return s, t
