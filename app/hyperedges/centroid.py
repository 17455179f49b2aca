"""The centroid of a changing set of points, without adding them all up each time (Numba)."""

from __future__ import annotations

from numba import njit

from app.arrays import Floats, Indices


@njit(cache=True)
def accumulate(total: Floats, point: Floats, sign: float) -> None:
    """Add a point (3,) to a running sum, or take it away with ``sign`` -1.

    ``total`` (2, 3) holds the sum and what rounding cut off it. Together they have twice the digits
    of a number (Knuth's TwoSum), so that what remains after many points came and went is right to
    the last place.
    """
    for axis in range(3):
        added = sign * point[axis]
        summed = total[0, axis] + added
        kept = summed - total[0, axis]
        lost = (total[0, axis] - (summed - kept)) + (added - kept)
        lost += total[1, axis]
        total[0, axis] = summed + lost
        total[1, axis] = lost - (total[0, axis] - summed)


@njit(cache=True)
def average(points: Floats, living: Indices, count: int, centroid: Floats) -> None:
    """Write the centroid (3,) of the points ``living[:count]``, added up in this order."""
    for axis in range(3):
        total = 0.0
        for place in range(count):
            total += points[living[place], axis]
        centroid[axis] = total / count
