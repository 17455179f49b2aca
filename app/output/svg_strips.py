"""Contours that cover pieces of bands (Numba).

All turn the same way, so that where they overlap they are one: x · y' - y · x' is positive around
what they cover.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices

THINNEST = 0.05
"""Pixels of a band's half width that are left, however much is taken from its sides."""

_TURN = np.linspace(0, 2 * np.pi, 20, endpoint=False)

CIRCLE = np.column_stack([np.cos(_TURN), np.sin(_TURN)])
"""A circle (20, 2) of radius 1."""


class Course(NamedTuple):
    """Samples of curves, and what is at them, as `app.output.svg_bands.Bands` has them.

    ``feet`` (2, p) are places in ``rims`` (f, 20, 2) of the round ends that a piece has at its
    first and at its second sample, -1 where it has none; these stand at ``foot_samples`` (f,).
    """

    centers: Floats
    widths: Floats
    sides: Floats
    balls: NDArray[np.bool_]
    firsts: Indices
    feet: Indices
    foot_samples: Indices
    rims: Floats


def cover(
    course: Course, pieces: Indices, wider: float, inset: float, *, feet: bool
) -> list[Floats]:
    """Contours (k, 2) that cover ``pieces`` (in order), ``wider`` radii wide less ``inset``.

    Without ``feet`` tubes end straight.
    """
    room = 96 * len(pieces)
    points, ends = np.empty((room, 2)), np.empty(8 * len(pieces), dtype=np.int64)
    count = _cover(course, pieces, wider, inset, feet, CIRCLE, points, ends)
    begin, found = 0, []
    for end in ends[:count].tolist():
        found.append(points[begin:end])
        begin = end
    return found


@njit(cache=True)
def _cover(
    course: Course,
    pieces: Indices,
    wider: float,
    inset: float,
    has_feet: bool,
    circle: Floats,
    points: Floats,
    ends: Indices,
) -> int:
    """Write contours one after another, and where each ends; their number."""
    used = count = 0
    quad = np.empty((4, 2))
    begin = 0
    while begin < len(pieces):
        end = begin
        while end < len(pieces) and _quad(course, pieces[end], wider, inset, quad):
            if end > begin and course.firsts[pieces[end]] != course.firsts[pieces[end - 1]] + 1:
                break
            points[used + end - begin] = quad[0]
            points[used + end - begin + 1] = quad[1]
            end += 1
        if end == begin:
            used, count = _triangles(quad, points, ends, used, count)
            begin += 1
            continue
        used += end - begin + 1
        for k in range(end - 1, begin - 1, -1):
            _quad(course, pieces[k], wider, inset, quad)
            points[used] = quad[2]
            used += 1
        points[used] = quad[3]
        used += 1
        ends[count] = used
        count += 1
        begin = end
    for piece in pieces:
        for side in range(2):
            foot = course.feet[side, piece]
            if foot < 0 or not has_feet:
                continue
            sample = course.foot_samples[foot]
            share = max(wider - inset / course.widths[sample], 0.01)
            used = _ring(course.centers[sample], course.rims[foot], share, points, used)
            ends[count] = used
            count += 1
        for sample in range(course.firsts[piece], course.firsts[piece] + 2):
            if course.balls[sample]:
                width = max(course.widths[sample] * wider - inset, THINNEST)
                used = _ring(course.centers[sample], circle, width, points, used)
                ends[count] = used
                count += 1
    return count


@njit(cache=True)
def _quad(course: Course, piece: int, wider: float, inset: float, quad: Floats) -> bool:
    """Write the corners of a piece; false where it crosses itself, inside a tight bend."""
    i = course.firsts[piece]
    near = max(course.widths[i] * wider - inset, THINNEST)
    far = max(course.widths[i + 1] * wider - inset, THINNEST)
    left = right = 0.0
    for axis in range(2):
        here, there = course.centers[i, axis], course.centers[i + 1, axis]
        quad[0, axis] = here + near * course.sides[i, axis]
        quad[1, axis] = there + far * course.sides[i + 1, axis]
        quad[2, axis] = there - far * course.sides[i + 1, axis]
        quad[3, axis] = here - near * course.sides[i, axis]
        left += (quad[1, axis] - quad[0, axis]) * (there - here)
        right += (quad[2, axis] - quad[3, axis]) * (there - here)
    return left >= 0.0 and right >= 0.0


@njit(cache=True)
def _triangles(
    quad: Floats, points: Floats, ends: Indices, used: int, count: int
) -> tuple[int, int]:
    """Write the four triangles between corners of a quad that crosses itself."""
    for without in range(4):
        a, b, c = quad[(without + 1) % 4], quad[(without + 2) % 4], quad[(without + 3) % 4]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        points[used] = a
        points[used + 1] = b if area > 0 else c
        points[used + 2] = c if area > 0 else b
        used += 3
        ends[count] = used
        count += 1
    return used, count


@njit(cache=True)
def _ring(center: Floats, ring: Floats, scale: float, points: Floats, used: int) -> int:
    for k in range(len(ring)):
        points[used, 0] = center[0] + scale * ring[k, 0]
        points[used, 1] = center[1] + scale * ring[k, 1]
        used += 1
    return used
