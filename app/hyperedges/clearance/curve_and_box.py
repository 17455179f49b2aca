"""A row of a piece of a curve and a box: how far they are from each other at least (Numba).

As `app.hyperedges.clearance.two_curves`, with the box's farthest corner in a direction in place of
the second curve.

Columns 0 to 11 are the cubic in the box's own axes, about its centre; 12 to 14 half the box's
sizes; 24 and 25 from where to where the piece is on its curve.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from app.arrays import Floats
from app.hyperedges.clearance.cubic import SLACK, copy, halve, lowest, point, spread


@njit(cache=True, error_model="numpy")
def place_before_box(
    p: Floats, center: Floats, rotation: Floats, half: Floats, rows: Floats
) -> float:
    """Write the curve ``p`` (4, 3) and the box to row 0; the power of two they are divided by.

    The box's axes are the columns of ``rotation`` (3, 3).
    """
    extent = 0.0
    for axis in range(3):
        rows[0, 12 + axis] = half[axis]
        extent = max(extent, half[axis])
        for k in range(4):
            here = 0.0
            for other in range(3):
                here += (p[k, other] - center[other]) * rotation[other, axis]
            rows[0, 3 * k + axis] = here
            extent = max(extent, abs(here))
    scale = math.ldexp(1.0, math.frexp(extent)[1]) if extent > 0.0 else 1.0
    for column in range(15):
        rows[0, column] /= scale
    rows[0, 24], rows[0, 25] = 0.0, 1.0
    return scale


@njit(cache=True, error_model="numpy")
def halve_before_box(rows: Floats, row: int, new: int) -> None:
    """Halve the curve of a row; the second half goes to row ``new``."""
    copy(rows, row, new, 0, 26)
    halve(rows, row, new, 0)
    middle = 0.5 * (rows[row, 24] + rows[row, 25])
    rows[row, 25] = middle
    rows[new, 24] = middle


@njit(cache=True, error_model="numpy")
def look_at_box(rows: Floats, row: int, upper: float) -> tuple[float, float, float]:
    """A lower bound, an upper bound and where it is; infinite where it is above ``upper``."""
    t = _nearest(rows, row)
    x, y, z = _beyond(rows, row, 0, t), _beyond(rows, row, 1, t), _beyond(rows, row, 2, t)
    length = math.sqrt(x * x + y * y + z * z)
    if length > 1e-9:
        x, y, z = x / length, y / length, z / length
        corner = abs(x) * rows[row, 12] + abs(y) * rows[row, 13] + abs(z) * rows[row, 14]
        key = lowest(rows, row, 0, x, y, z) - corner - SLACK
        if key >= upper:
            return key, np.inf, 0.0
    else:
        key = -spread(rows, row, 0) - SLACK
    here = math.sqrt(_square_beyond(rows, row, *point(rows, row, 0, t))) + SLACK
    return key, here, rows[row, 24] + t * (rows[row, 25] - rows[row, 24])


@njit(cache=True, error_model="numpy", inline="always")
def _beyond(rows: Floats, row: int, axis: int, t: float) -> float:
    """How far the chord's point is beyond the box along one axis, with its sign."""
    x = rows[row, axis] + t * (rows[row, axis + 9] - rows[row, axis])
    half = rows[row, 12 + axis]
    return float(x - min(max(x, -half), half))


@njit(cache=True, error_model="numpy")
def _square_beyond(rows: Floats, row: int, x: float, y: float, z: float) -> float:
    """Squared distance of a point from the box."""
    a = max(abs(x) - rows[row, 12], 0.0)
    b = max(abs(y) - rows[row, 13], 0.0)
    c = max(abs(z) - rows[row, 14], 0.0)
    return float(a * a + b * b + c * c)


@njit(cache=True, error_model="numpy")
def _slope(rows: Floats, row: int, t: float) -> float:
    """Half of how the squared distance of the chord's point grows with ``t``."""
    total = 0.0
    for axis in range(3):
        total += (rows[row, axis + 9] - rows[row, axis]) * _beyond(rows, row, axis, t)
    return total


@njit(cache=True, error_model="numpy")
def _nearest(rows: Floats, row: int) -> float:
    """Where the chord of a row's piece is nearest to the box.

    The slope grows along the chord, and evenly between the places where the chord crosses the
    planes of the box's sides: so these close in on where it is zero, and a line finds it.
    """
    low, high = 0.0, 1.0
    slope_low, slope_high = _slope(rows, row, low), _slope(rows, row, high)
    if slope_low >= 0.0:
        return low
    if slope_high <= 0.0:
        return high
    for axis in range(3):
        start = rows[row, axis]
        run = rows[row, axis + 9] - start
        for side in (-1.0, 1.0):
            crossing = (side * rows[row, 12 + axis] - start) / run if run != 0.0 else -1.0
            if low < crossing < high:
                slope = _slope(rows, row, crossing)
                if slope < 0.0:
                    low, slope_low = crossing, slope
                else:
                    high, slope_high = crossing, slope
    return low + (high - low) * slope_low / (slope_low - slope_high)
