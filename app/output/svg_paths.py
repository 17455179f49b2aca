"""Contours as paths: corners stay sharp, what is smooth becomes a few cubic Bezier curves.

The fit is Schneider's (1990, "An algorithm for automatically fitting digitized curves", Graphics
Gems): least squares for the lengths of both handles, halved where it is too far off.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numba import njit

from app.arrays import Floats, Indices

TOLERANCE = 0.12
"""Pixels by which a curve may be off."""

CORNER = np.cos(np.radians(24.0))
"""Cosine of the turn from which on a vertex is a corner."""


UNEVEN = 2.2
"""Between neighbouring sides of which one is as much longer, a vertex is a corner, unless there is
hardly a turn."""

STRAIGHT = np.cos(np.radians(1.5))


def path(contours: Sequence[Floats], *, closed: bool = True, smooth: bool = True) -> str:
    """Contours (k, 2) as the data of a path, rounded to hundredths of pixels.

    Those that are not ``smooth`` keep all their vertices, with straight lines between them.
    """
    return "".join(
        _contour(ring, closed) if smooth and len(ring) > 4 else _polygon(ring, closed)
        for ring in contours
    )


def _polygon(ring: Floats, closed: bool) -> str:
    """A few vertices, joined by straight lines."""
    points = np.rint(ring * 100).astype(np.int64).tolist()
    if len(points) < 2:
        return ""
    x, y = points[0]
    text = [f"M{_digits(x)} {_digits(y)}l"]
    for a, b in points[1:]:
        text.append(f"{_digits(a - x)} {_digits(b - y)}")
        x, y = a, b
    return text[0] + " ".join(text[1:]) + ("z" if closed else "")


def _contour(ring: Floats, closed: bool) -> str:
    points = _distinct(np.asarray(ring, dtype=np.float64), closed)
    if len(points) <= 4:
        return _polygon(points, closed)
    corners = _corners(points, closed)
    is_smooth = closed and len(corners) == 0
    if closed:
        first = int(corners[0]) if len(corners) else 0
        points = np.concatenate([points[first:], points[: first + 1]])
        corners = corners[1:] - first
    corners = np.concatenate([corners, [len(points) - 1]])
    curves = fit(points, np.concatenate([[0], corners]), is_smooth)
    return _written(curves) + ("z" if closed else "")


def _distinct(points: Floats, closed: bool) -> Floats:
    """The same without vertices that are hardly apart."""
    after = np.concatenate([points[1:], points[:1]])
    apart = np.abs(after - points).max(axis=1) > 0.005
    if not closed:
        apart[-1] = True
    kept: Floats = points[apart]
    return kept


def _corners(points: Floats, closed: bool) -> Indices:
    """Where the contour turns sharply, or a long straight side ends."""
    after = np.concatenate([points[1:], points[:1]]) - points
    before = np.concatenate([after[-1:], after[:-1]])
    one = np.sqrt(np.einsum("ij,ij->i", before, before))
    other = np.concatenate([one[1:], one[:1]])
    turn = np.einsum("ij,ij->i", before, after) / np.maximum(one * other, 1e-12)
    # Samples of a curve lie about evenly: a side much longer than its neighbours is straight.
    jump = (np.maximum(one, other) > UNEVEN * np.minimum(one, other)) & (turn < STRAIGHT)
    found = (turn < CORNER) | jump
    if not closed:
        found[[0, -1]] = False
    return np.flatnonzero(found)


def _written(curves: Floats) -> str:
    """Curves (c, 3, 2), the first a place to begin at, as relative commands."""
    rounded = np.rint(curves * 100).astype(np.int64)
    moves = (rounded[1:] - rounded[:-1, 2:]).reshape(-1, 6)
    are_lines = ((moves[:, :2] == 0) & (moves[:, 2:4] == moves[:, 4:])).all(axis=1).tolist()
    x, y = rounded[0, 2].tolist()
    text = [f"M{_digits(x)} {_digits(y)}"]
    was = ""
    for move, is_line in zip(moves.tolist(), are_lines, strict=True):
        letter, numbers = ("l", move[4:]) if is_line else ("c", move)
        digits = " ".join(map(_digits, numbers))
        text.append(f"{letter}{digits}" if letter != was else f" {digits}")
        was = letter
    return "".join(text).replace(" -", "-")


@lru_cache(maxsize=50_000)
def _digits(hundredths: int) -> str:
    """Hundredths as a number, as short as it can be."""
    sign = "-" if hundredths < 0 else ""
    whole, rest = divmod(abs(hundredths), 100)
    digits = f".{rest:02d}".rstrip("0") if rest else ""
    return f"{sign}{whole if whole or not rest else ''}{digits}"


def fit(points: Floats, breaks: Indices, is_smooth: bool) -> Floats:
    """Curves (c, 3, 2) through points (p, 2) that begin and end at ``breaks``.

    The first row holds where they begin; each further row is a curve's two inner control points and
    its end. A contour that ``is_smooth`` has no corner where it closes.
    """
    found = np.empty((2 * len(points) + 2, 3, 2))
    count = _fit(points, breaks.astype(np.int64), is_smooth, TOLERANCE, found)
    fitted: Floats = found[:count]
    return fitted


@njit(cache=True)
def _fit(points: Floats, breaks: Indices, is_smooth: bool, tolerance: float, found: Floats) -> int:
    found[0, :] = points[0]
    count = 1
    stack = np.empty((64, 2), np.int64)
    inner = np.empty((2, 2))
    for k in range(len(breaks) - 1):
        begin, end = breaks[k], breaks[k + 1]
        start, stop = _tangent(points, begin, 1, begin, end), _tangent(points, end, -1, begin, end)
        if is_smooth:
            x = points[1, 0] - points[len(points) - 2, 0]
            y = points[1, 1] - points[len(points) - 2, 1]
            length = max(np.hypot(x, y), 1e-12)
            start, stop = (x / length, y / length), (-x / length, -y / length)
        waiting = 1
        stack[0] = begin, end
        while waiting > 0:
            waiting -= 1
            a, b = stack[waiting]
            one = start if a == begin else _tangent(points, a, 1, begin, end)
            other = stop if b == end else _tangent(points, b, -1, begin, end)
            if b - a == 1:
                if end - begin == 1:
                    inner[0], inner[1] = points[a], points[b]
                else:
                    _short(points[a], points[b], one, other, inner)
            else:
                worst = _least_squares(points, a, b, one, other, inner)
                if worst > tolerance and waiting < 62:
                    half = (a + b) // 2
                    stack[waiting] = half, b
                    stack[waiting + 1] = a, half
                    waiting += 2
                    continue
            found[count, 0], found[count, 1], found[count, 2] = inner[0], inner[1], points[b]
            count += 1
    return count


@njit(cache=True)
def _short(
    a: Floats, b: Floats, one: tuple[float, float], other: tuple[float, float], inner: Floats
) -> None:
    third = np.hypot(b[0] - a[0], b[1] - a[1]) / 3.0
    inner[0, 0], inner[0, 1] = a[0] + third * one[0], a[1] + third * one[1]
    inner[1, 0], inner[1, 1] = b[0] + third * other[0], b[1] + third * other[1]


@njit(cache=True)
def _tangent(points: Floats, at: int, way: int, begin: int, end: int) -> tuple[float, float]:
    """Unit vector along the contour (``way`` 1) or against it, by the neighbours between breaks."""
    low, high = at - 1, at + 1
    if begin < at < end:
        x, y = points[high, 0] - points[low, 0], points[high, 1] - points[low, 1]
        sign = way
    else:
        # A parabola through three points knows where they head better than a chord does.
        x, y = points[at + way, 0] - points[at, 0], points[at + way, 1] - points[at, 1]
        if end - begin >= 2:
            u, v = points[at + 2 * way, 0] - points[at, 0], points[at + 2 * way, 1] - points[at, 1]
            s, t = np.hypot(x, y), np.hypot(u - x, v - y)
            x, y = x * (s + t) / s - u * s / (s + t), y * (s + t) / s - v * s / (s + t)
        sign = 1
    length = max(np.hypot(x, y), 1e-12)
    return sign * x / length, sign * y / length


@njit(cache=True)
def _least_squares(
    points: Floats,
    a: int,
    b: int,
    one: tuple[float, float],
    other: tuple[float, float],
    inner: Floats,
) -> float:
    """Write the two handles' ends; the farthest any point between a and b is from the curve."""
    total = 0.0
    for i in range(a, b):
        total += np.hypot(points[i + 1, 0] - points[i, 0], points[i + 1, 1] - points[i, 1])
    c00 = c01 = c11 = x0 = x1 = 0.0
    done = 0.0
    dot = one[0] * other[0] + one[1] * other[1]
    for i in range(a + 1, b):
        done += np.hypot(points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1])
        t = done / total
        s = 1.0 - t
        b1, b2 = 3 * s * s * t, 3 * s * t * t
        b0, b3 = s * s * s + b1, t * t * t + b2
        x = points[i, 0] - b0 * points[a, 0] - b3 * points[b, 0]
        y = points[i, 1] - b0 * points[a, 1] - b3 * points[b, 1]
        c00 += b1 * b1
        c01 += b1 * b2 * dot
        c11 += b2 * b2
        x0 += b1 * (x * one[0] + y * one[1])
        x1 += b2 * (x * other[0] + y * other[1])
    det = c00 * c11 - c01 * c01
    first = second = total / 3.0
    if abs(det) > 1e-9 * c00 * c11:
        first, second = (x0 * c11 - x1 * c01) / det, (x1 * c00 - x0 * c01) / det
        if not (0.02 * total < first < 2 * total and 0.02 * total < second < 2 * total):
            first = second = total / 3.0
    for axis in range(2):
        inner[0, axis] = points[a, axis] + first * one[axis]
        inner[1, axis] = points[b, axis] + second * other[axis]
    return _farthest(points, a, b, inner)


@njit(cache=True)
def _farthest(points: Floats, a: int, b: int, inner: Floats) -> float:
    """How far points are from the curve at most, looked for near where they should be."""
    worst = 0.0
    steps = 4 * (b - a)
    place = 0
    for i in range(a + 1, b):
        best = np.inf
        for k in range(place, steps + 1):
            t = k / steps
            s = 1.0 - t
            x = s * s * s * points[a, 0] + 3 * s * s * t * inner[0, 0]
            x += 3 * s * t * t * inner[1, 0] + t * t * t * points[b, 0] - points[i, 0]
            y = s * s * s * points[a, 1] + 3 * s * s * t * inner[0, 1]
            y += 3 * s * t * t * inner[1, 1] + t * t * t * points[b, 1] - points[i, 1]
            # Only what is across the curve counts: how points are spaced along it does not.
            dx = s * s * (inner[0, 0] - points[a, 0]) + 2 * s * t * (inner[1, 0] - inner[0, 0])
            dx += t * t * (points[b, 0] - inner[1, 0])
            dy = s * s * (inner[0, 1] - points[a, 1]) + 2 * s * t * (inner[1, 1] - inner[0, 1])
            dy += t * t * (points[b, 1] - inner[1, 1])
            length = max(np.hypot(dx, dy), 1e-12)
            along, across = (x * dx + y * dy) / length, abs(x * dy - y * dx) / length
            distance = max(across, abs(along) - 3.0 * length / steps)
            if distance < best:
                best = distance
                place = k
            elif along > 4.0 * length / steps:
                break
        worst = max(worst, best)
    return worst
