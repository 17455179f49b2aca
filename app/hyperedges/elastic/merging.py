"""Single cubics in place of several of a spline, where those bend too much (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats
from app.hyperedges.weaving.curvature import bend_between

GENTLE = 2.5
"""Radius of curvature, over the tube's, at which no better handles are looked for."""

TIGHT = 1.65
"""The same below which a piece becomes one with those beside it."""

MOST_SEGMENTS = 5
"""So many at most."""


@njit(cache=True, error_model="numpy")
def sweep(
    at_join: bool,
    wanted: int,
    at_start: bool,
    count: int,
    places: Floats,
    units: Floats,
    radius: float,
) -> int:
    """Over how many segments the cubic at an end goes: more where one would be too tight.

    Of a chain of ``count`` segments, between knots at ``places`` (n, 3) with unit tangents
    ``units`` (n, 3). So many as are ``wanted``, if that is more than one.
    """
    if not at_join or count < 2:
        return 1
    if wanted > 1:
        return min(wanted, count)
    curve = np.empty((4, 3))
    best, widest = 1, 0.0
    for k in range(1, min(MOST_SEGMENTS, count) + 1):
        begin, end = (0, k) if at_start else (count - k, count)
        curve[0], curve[3] = places[begin], places[end]
        radius_there = bend_between(curve, units[begin], units[end], GENTLE * radius)
        if radius_there > widest:
            best, widest = k, radius_there
        if widest >= TIGHT * radius:
            break
    return best


@njit(cache=True, error_model="numpy")
def wider(
    inner: tuple[int, int],
    begin: int,
    places: Floats,
    units: Floats,
    radius: float,
    widest: float,
    curve: Floats,
) -> tuple[int, int]:
    """Between which knots one cubic goes instead of that from ``begin`` to the next, ``curve``.

    Between two of the knots ``inner``, where it bends less: by as few segments as will do.
    """
    found = (begin, begin + 1)
    other = np.empty((4, 3))
    for size in range(2, MOST_SEGMENTS + 1):
        for back in range(size):
            first = begin - back
            last = first + size
            if first < inner[0] or last > inner[1]:
                continue
            other[0], other[3] = places[first], places[last]
            there = bend_between(other, units[first], units[last], GENTLE * radius)
            if there > widest:
                widest, found = there, (first, last)
                curve[:] = other
        if widest >= TIGHT * radius:
            break
    return found
