"""Who is in front of whom: triangles over a grid of pixels (Numba).

Triangles are (t, 3, 3): x, y in pixels and nearness, which is larger in front and linear over a
triangle. Nothing here is drawn; the grid only answers questions of order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices, Singles

NOBODY = -1

_HIDDEN = 1 << 32
"""Added to a count of pixels at those where the one is hidden."""


class Foremost(NamedTuple):
    """What is nearest at each pixel: ``nearness`` and ``owners`` (height, width), `NOBODY` free."""

    nearness: Singles
    owners: NDArray[np.int32]


class Tally(NamedTuple):
    """Counts of pairs, by open addressing; ``keys`` are -1 where a place is free."""

    keys: Indices
    counts: Indices


def foremost(triangles: Floats, owners: Indices, width: int, height: int) -> Foremost:
    """The nearest triangle's owner (t,) at each pixel."""
    found = Foremost(
        np.full((height, width), -np.inf, dtype=np.float32),
        np.full((height, width), NOBODY, dtype=np.int32),
    )
    _fill(triangles, owners, found)
    return found


def overlaps(
    triangles: Floats, owners: Indices, width: int, height: int, reach: int = 1
) -> tuple[Indices, Indices]:
    """Pairs (k, 2) of owners, one behind another at some pixel, and at how many (k,).

    There are at most ``reach`` - 1 others between them: with 1 it is right behind.
    """
    starts = np.zeros(width * height + 1, dtype=np.int64)
    _count(triangles, width, height, starts)
    starts = np.cumsum(starts)
    size = int(starts[-1])
    layers, nearness = np.empty(size, dtype=np.int32), np.empty(size, dtype=np.float32)
    _gather(triangles, owners, width, height, starts.copy(), layers, nearness)
    most = int(owners.max(initial=0)) + 1
    return _pairs(_layered(starts, layers, nearness, reach, most, _empty(256)), most)


def hidden(
    triangles: Floats, owners: Indices, families: Indices, room: Floats, before: Foremost
) -> tuple[Indices, Indices]:
    """Which owners hide which: pairs (k, 2) of who is hidden and who hides, and how many pixels.

    Of these (k, 2) the first column counts where the one is hidden, the second where the other is
    foremost there at all.

    ``owners`` (2, t) say whose a triangle is, and of which family; ``families`` (f,) are those of
    the owners ``before``. One of another family hides a triangle where it is nearer by more than
    ``room[0]`` (2, t), one of its own where by more than ``room[1]``.
    """
    most = int(before.owners.max(initial=0)) + 1
    pairs, counts = _pairs(
        _hidden(triangles, owners[0], owners[1], families, room, before, most, _empty(1024)), most
    )
    found = counts >= _HIDDEN
    return pairs[found], np.stack(np.divmod(counts[found], _HIDDEN), axis=1)


def _empty(size: int) -> Tally:
    return Tally(np.full(size, -1, dtype=np.int64), np.zeros(size, dtype=np.int64))


def _pairs(tally: Tally, most: int) -> tuple[Indices, Indices]:
    taken = np.flatnonzero(tally.keys >= 0)
    keys, counts = tally.keys[taken], tally.counts[taken]
    order = np.argsort(keys)
    keys = keys[order]
    return np.stack([keys // most, keys % most], axis=1), counts[order]


@njit(cache=True)
def _add(tally: Tally, key: int, count: int) -> bool:
    """Count a pair; whether it was new."""
    mask = len(tally.keys) - 1
    place = (key * 0x9E3779B1 >> 7) & mask
    while tally.keys[place] != key:
        if tally.keys[place] < 0:
            tally.keys[place] = key
            tally.counts[place] = count
            return True
        place = (place + 1) & mask
    tally.counts[place] += count
    return False


@njit(cache=True)
def _wider(tally: Tally) -> Tally:
    size = 2 * len(tally.keys)
    wider = Tally(np.full(size, -1), np.zeros(size, np.int64))
    for place in range(len(tally.keys)):
        if tally.keys[place] >= 0:
            _add(wider, tally.keys[place], tally.counts[place])
    return wider


@njit(cache=True, error_model="numpy")
def _span(triangle: Floats, y: float, width: int) -> tuple[int, int]:
    """From which to which pixel, the last one not included, a triangle covers the row at y."""
    low, high = np.inf, -np.inf
    for k in range(3):
        ax, ay = triangle[k, 0], triangle[k, 1]
        bx, by = triangle[(k + 1) % 3, 0], triangle[(k + 1) % 3, 1]
        if (ay <= y) != (by <= y):
            x = ax + (y - ay) / (by - ay) * (bx - ax)
            low, high = min(low, x), max(high, x)
    if low >= width or high <= 0.0 or not low < high:
        return 0, 0
    return max(int(np.ceil(low - 0.5)), 0), min(int(np.ceil(high - 0.5)), width)


@njit(cache=True, error_model="numpy")
def _rows(triangle: Floats, height: int) -> tuple[int, int]:
    low = min(triangle[0, 1], triangle[1, 1], triangle[2, 1])
    high = max(triangle[0, 1], triangle[1, 1], triangle[2, 1])
    if low >= height or high <= 0.0:
        return 0, 0
    return max(int(np.ceil(low - 0.5)), 0), min(int(np.ceil(high - 0.5)), height)


@njit(cache=True, error_model="numpy")
def _slopes(triangle: Floats) -> tuple[float, float]:
    """How nearness changes along x and along y; both 0 for triangles seen edge on."""
    ax, ay = triangle[1, 0] - triangle[0, 0], triangle[1, 1] - triangle[0, 1]
    bx, by = triangle[2, 0] - triangle[0, 0], triangle[2, 1] - triangle[0, 1]
    area = ax * by - ay * bx
    if abs(area) < 1e-9:
        return 0.0, 0.0
    a, b = triangle[1, 2] - triangle[0, 2], triangle[2, 2] - triangle[0, 2]
    return (a * by - b * ay) / area, (b * ax - a * bx) / area


@njit(cache=True, error_model="numpy")
def _fill(triangles: Floats, owners: Indices, found: Foremost) -> None:
    height, width = found.owners.shape
    for t in range(len(triangles)):
        triangle = triangles[t]
        along, down = _slopes(triangle)
        first, last = _rows(triangle, height)
        for row in range(first, last):
            begin, end = _span(triangle, row + 0.5, width)
            base = triangle[0, 2] + down * (row + 0.5 - triangle[0, 1])
            for column in range(begin, end):
                near = base + along * (column + 0.5 - triangle[0, 0])
                if near > found.nearness[row, column]:
                    found.nearness[row, column] = near
                    found.owners[row, column] = owners[t]


@njit(cache=True, error_model="numpy")
def _count(triangles: Floats, width: int, height: int, starts: Indices) -> None:
    for t in range(len(triangles)):
        first, last = _rows(triangles[t], height)
        for row in range(first, last):
            begin, end = _span(triangles[t], row + 0.5, width)
            for column in range(begin, end):
                starts[row * width + column + 1] += 1


@njit(cache=True, error_model="numpy")
def _gather(
    triangles: Floats,
    owners: Indices,
    width: int,
    height: int,
    places: Indices,
    layers: NDArray[np.int32],
    nearness: Singles,
) -> None:
    """Write all layers of each pixel, the farthest first."""
    begins = places.copy()
    for t in range(len(triangles)):
        triangle = triangles[t]
        along, down = _slopes(triangle)
        first, last = _rows(triangle, height)
        for row in range(first, last):
            begin, end = _span(triangle, row + 0.5, width)
            base = triangle[0, 2] + down * (row + 0.5 - triangle[0, 1])
            for column in range(begin, end):
                near = base + along * (column + 0.5 - triangle[0, 0])
                pixel = row * width + column
                place = places[pixel]
                places[pixel] += 1
                while place > begins[pixel] and nearness[place - 1] > near:
                    nearness[place] = nearness[place - 1]
                    layers[place] = layers[place - 1]
                    place -= 1
                nearness[place] = near
                layers[place] = owners[t]


@njit(cache=True, error_model="numpy")
def _layered(
    starts: Indices,
    layers: NDArray[np.int32],
    nearness: Singles,
    reach: int,
    most: int,
    tally: Tally,
) -> Tally:
    used = 0
    for pixel in range(len(starts) - 1):
        for place in range(starts[pixel] + 1, starts[pixel + 1]):
            for behind in range(max(place - reach, starts[pixel]), place):
                one, other = layers[behind], layers[place]
                if one == other or nearness[behind] == nearness[place]:
                    continue
                if _add(tally, np.int64(one) * most + other, 1):
                    used += 1
                    if 2 * used > len(tally.keys):
                        tally = _wider(tally)
    return tally


@njit(cache=True, error_model="numpy")
def _hidden(
    triangles: Floats,
    owners: Indices,
    own: Indices,
    families: Indices,
    room: Floats,
    before: Foremost,
    most: int,
    tally: Tally,
) -> Tally:
    height, width = before.owners.shape
    used = 0
    for t in range(len(triangles)):
        triangle = triangles[t]
        along, down = _slopes(triangle)
        first, last = _rows(triangle, height)
        for row in range(first, last):
            begin, end = _span(triangle, row + 0.5, width)
            base = triangle[0, 2] + down * (row + 0.5 - triangle[0, 1])
            for column in range(begin, end):
                hider = before.owners[row, column]
                if hider < 0:
                    continue
                near = base + along * (column + 0.5 - triangle[0, 0])
                needed = room[1, t] if families[hider] == own[t] else room[0, t]
                is_hidden = before.nearness[row, column] > near + needed
                if not is_hidden and owners[t] == hider:
                    continue
                if _add(tally, owners[t] * most + hider, 1 + (_HIDDEN if is_hidden else 0)):
                    used += 1
                    if 2 * used > len(tally.keys):
                        tally = _wider(tally)
    return tally
