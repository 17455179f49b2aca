"""How high each hyperedge rises: its join plane, where the document does not say.

Hyperedges whose footprints (their boxes seen from above) overlap get different levels; each takes
the lowest that is free, short ones first, so that they stay low. Footprints are rounded to the
cells of a coarse grid: that costs a level here and there, and never looks at all pairs.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices

CELLS = 64
"""Of the grid, along each side: a picture has room for no more columns of tubes."""

LEVELS = 512
"""Levels that one cell can tell apart; where more hyperedges overlap, the last is shared."""

RISE = 0.22
"""Height of an arch over its span: lower ones look flat, higher ones like hoops."""

LOWEST_RISE = 5.0
"""Least height of an arch, in radii of its tube: room for two bends."""

HIGHEST_RISE = 3.0
"""Greatest height that a span alone asks for, in document units."""


def choose_join_planes(
    attachments: Floats,
    starts: Indices,
    radii: Floats,
    clearance: float,
    obstacle_lows: Floats,
    obstacle_highs: Floats,
) -> Floats:
    """Join planes (h,), world z, of hyperedges whose ``attachments`` (a, 3) begin at ``starts``.

    ``radii`` (h,) are the tubes', ``clearance`` is wanted between surfaces. ``obstacle_lows`` and
    ``obstacle_highs`` (n, 3) are the items' boxes, above which a join plane should lie.
    """
    if len(starts) < 2:
        return np.zeros(0)
    lows = np.minimum.reduceat(attachments, starts[:-1], axis=0)
    highs = np.maximum.reduceat(attachments, starts[:-1], axis=0)
    spans = np.hypot(*(highs - lows)[:, :2].T)
    margins = 2.0 * radii + clearance
    step = float(margins.max())
    origin = lows[:, :2].min(axis=0)
    size = float(max((highs[:, :2].max(axis=0) - origin).max(), 1e-9)) / CELLS
    first = _cells(lows[:, :2] - margins[:, None], origin, size)
    last = _cells(highs[:, :2] + margins[:, None], origin, size)
    tops = _tops(
        _cells(obstacle_lows[:, :2], origin, size),
        _cells(obstacle_highs[:, :2], origin, size),
        np.ascontiguousarray(obstacle_highs[:, 2]),
    )
    floors = np.maximum(highs[:, 2], _highest(tops, first, last))
    rises = np.maximum(np.minimum(RISE * spans, HIGHEST_RISE), LOWEST_RISE * radii)
    ground = float(floors.min())
    wanted = np.ceil((floors + rises - ground) / step - 1e-9).astype(np.int64)
    order = np.argsort(spans, kind="stable")
    levels = _levels(first, last, np.maximum(wanted, 0), order)
    return np.asarray(ground + step * levels)


def _cells(places: Floats, origin: Floats, size: float) -> Indices:
    cells = np.floor((places - origin) / size)
    return np.ascontiguousarray(np.clip(cells, 0, CELLS - 1).astype(np.int64))


@njit(cache=True)
def _tops(first: Indices, last: Indices, heights: Floats) -> Floats:
    """The highest item over each cell of the grid."""
    tops = np.full((CELLS, CELLS), -np.inf)
    for k in range(len(heights)):
        for x in range(first[k, 0], last[k, 0] + 1):
            for y in range(first[k, 1], last[k, 1] + 1):
                tops[x, y] = max(tops[x, y], heights[k])
    return tops


@njit(cache=True)
def _highest(tops: Floats, first: Indices, last: Indices) -> Floats:
    highest = np.full(len(first), -np.inf)
    for k in range(len(first)):
        for x in range(first[k, 0], last[k, 0] + 1):
            for y in range(first[k, 1], last[k, 1] + 1):
                highest[k] = max(highest[k], tops[x, y])
    return highest


@njit(cache=True)
def _levels(first: Indices, last: Indices, wanted: Indices, order: Indices) -> Indices:
    """The lowest level from ``wanted`` on that is free in all cells, in the order given."""
    words = LEVELS // 64
    taken = np.zeros((CELLS, CELLS, words), np.uint64)
    used = np.empty(words, np.uint64)
    levels = np.empty(len(wanted), np.int64)
    one = np.uint64(1)
    for k in order:
        used[:] = 0
        for x in range(first[k, 0], last[k, 0] + 1):
            for y in range(first[k, 1], last[k, 1] + 1):
                for word in range(words):
                    used[word] |= taken[x, y, word]
        offset = max(wanted[k] - LEVELS // 2, 0)
        level = wanted[k] - offset
        while level < LEVELS - 1 and used[level >> 6] >> np.uint64(level & 63) & one:
            level += 1
        levels[k] = level + offset
        for x in range(first[k, 0], last[k, 0] + 1):
            for y in range(first[k, 1], last[k, 1] + 1):
                taken[x, y, level >> 6] |= one << np.uint64(level & 63)
    return levels
