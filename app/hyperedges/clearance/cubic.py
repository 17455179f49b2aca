"""Cubics in rows of numbers: halving, points, and how far they leave their chords (Numba).

A cubic is twelve numbers in a row: the coordinates of its control points, one after another.

With D1 = P1 - (2 P0 + P3) / 3 and D2 = P2 - (P0 + 2 P3) / 3 a cubic is its chord, run through
evenly, plus 3t(1-t)²·D1 + 3t²(1-t)·D2. The two weights are never more than 3t(1-t) ≤ 3/4 together.
Hence it is no farther from its chord than 3/4 of the longer of D1 and D2, and in any one direction
no farther than 3/4 of the larger of their parts. Halving divides both by four.
"""

from __future__ import annotations

import math

from numba import njit

from app.arrays import Floats

SLACK = 1e-12
"""Of a pair's extent: more than rounding can add up to.

Coordinates are taken from the middle of the pair, which rounds each by half an ulp of itself, and
scaled by a power of two, which is exact. A halving rounds three times, a dot product five times. A
piece is left whole once it is within `SLACK` of its chord, hence after 25 halvings: together some
100 roundings of 1.1e-16 each, and a unit vector that is off by four.
"""


@njit(cache=True, error_model="numpy")
def halve(rows: Floats, row: int, new: int, column: int) -> None:
    """Keep the first half of the cubic at ``column`` of a row, and write the second to ``new``."""
    for axis in range(column, column + 3):
        a, b, c, d = rows[row, axis], rows[row, axis + 3], rows[row, axis + 6], rows[row, axis + 9]
        ab, bc, cd = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d)
        abc, bcd = 0.5 * (ab + bc), 0.5 * (bc + cd)
        middle = 0.5 * (abc + bcd)
        rows[row, axis + 3], rows[row, axis + 6], rows[row, axis + 9] = ab, abc, middle
        rows[new, axis], rows[new, axis + 3] = middle, bcd
        rows[new, axis + 6], rows[new, axis + 9] = cd, d


@njit(cache=True, error_model="numpy")
def copy(rows: Floats, row: int, new: int, begin: int, end: int) -> None:
    """Copy some columns of one row to another."""
    for column in range(begin, end):
        rows[new, column] = rows[row, column]


@njit(cache=True, error_model="numpy")
def point(rows: Floats, row: int, column: int, t: float) -> tuple[float, float, float]:
    """The cubic's point at ``t``."""
    r = 1.0 - t
    a, b, c, d = r * r * r, 3.0 * r * r * t, 3.0 * r * t * t, t * t * t
    return (
        a * rows[row, column]
        + b * rows[row, column + 3]
        + c * rows[row, column + 6]
        + d * rows[row, column + 9],
        a * rows[row, column + 1]
        + b * rows[row, column + 4]
        + c * rows[row, column + 7]
        + d * rows[row, column + 10],
        a * rows[row, column + 2]
        + b * rows[row, column + 5]
        + c * rows[row, column + 8]
        + d * rows[row, column + 11],
    )


@njit(cache=True, error_model="numpy")
def spread(rows: Floats, row: int, column: int) -> float:
    """No point of the cubic is farther than this from the point of its chord at the same t."""
    most_first, most_second = 0.0, 0.0
    for axis in range(column, column + 3):
        start, end = rows[row, axis], rows[row, axis + 9]
        first = rows[row, axis + 3] - (2.0 * start + end) / 3.0
        second = rows[row, axis + 6] - (start + 2.0 * end) / 3.0
        most_first += first * first
        most_second += second * second
    return 0.75 * math.sqrt(max(most_first, most_second))


@njit(cache=True, error_model="numpy")
def lowest(rows: Floats, row: int, column: int, x: float, y: float, z: float) -> float:
    """A bound from below of how far the cubic reaches along the unit vector x, y, z.

    The better of two: what its chord reaches less what the cubic may leave it by in this direction,
    and the lowest of its control points.
    """
    a = x * rows[row, column] + y * rows[row, column + 1] + z * rows[row, column + 2]
    b = x * rows[row, column + 3] + y * rows[row, column + 4] + z * rows[row, column + 5]
    c = x * rows[row, column + 6] + y * rows[row, column + 7] + z * rows[row, column + 8]
    d = x * rows[row, column + 9] + y * rows[row, column + 10] + z * rows[row, column + 11]
    chord = min(a, d)
    bend = min(b - (2.0 * a + d) / 3.0, c - (a + 2.0 * d) / 3.0)
    return float(max(min(chord, b, c), chord + 0.75 * min(bend, 0.0)))
