"""Rectangles in rows: how the contents of a tray, or all roots, stand beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from app.arrays import Floats

Arrangement = Literal["row", "column", "rows"]

ASPECT = 1.15
"""Width over depth that contents aim at: seen from the usual view, it fills a picture of 4:3."""

FEW = 12
"""Up to so many rectangles, all row widths that make a difference are tried."""

TRIES = 40
"""Row widths tried for more rectangles."""

THIN = 1e-9
"""What counts as the width or depth of a rectangle that has none: letters without ink."""


@dataclass(frozen=True, slots=True)
class Arranged:
    """Rectangles put in rows, the first row at the back (largest y), each from left to right.

    ``centers`` are relative to the centre of the whole; ``depths`` are those of each one's row.
    """

    centers: tuple[tuple[float, float], ...]
    depths: tuple[float, ...]
    width: float
    depth: float


def arrange(
    sizes: Sequence[tuple[float, float]], gap: float, arrangement: Arrangement = "rows"
) -> Arranged:
    """Rectangles of ``sizes`` (width, depth), in their order, ``gap`` apart.

    >>> arrange([(1.0, 1.0), (1.0, 1.0)], 0.5, "row").width
    2.5
    """
    arranged = _kept if len(sizes) <= FEW else _arranged
    return arranged(tuple(sizes), gap, arrangement)


# Small groups come again and again; large ones would only fill the memory of a long-lived process.
@lru_cache(maxsize=4096)
def _kept(sizes: tuple[tuple[float, float], ...], gap: float, arrangement: Arrangement) -> Arranged:
    return _arranged(sizes, gap, arrangement)


def _arranged(
    sizes: tuple[tuple[float, float], ...], gap: float, arrangement: Arrangement
) -> Arranged:
    if not sizes:
        return Arranged((), (), 0.0, 0.0)
    widths = np.array([size[0] for size in sizes])
    if arrangement == "row" or len(sizes) == 1:
        rows = [len(sizes)]
    elif arrangement == "column":
        rows = [1] * len(sizes)
    else:
        rows = _best_rows(widths, np.array([size[1] for size in sizes]), gap)
    return _stand(sizes, rows, gap)


def _best_rows(widths: Floats, depths: Floats, gap: float) -> list[int]:
    """How many rectangles stand in each row, for the smallest and best proportioned whole."""
    # Where each rectangle begins if all stood in one row.
    begins = np.concatenate([[0.0], np.cumsum(widths + gap)])
    whole = float(begins[-1] - gap)
    widest = max(float(widths.max()), THIN)
    best = (np.inf, [len(widths)])
    for width in _row_widths(begins, gap, widest, whole, len(widths)):
        rows: list[int] = []
        wide = deep = 0.0
        first = 0
        while first < len(widths):
            last = int(np.searchsorted(begins, begins[first] + width + gap + 1e-9, "right")) - 1
            last = max(last, first + 1)
            rows.append(last - first)
            wide = max(wide, float(begins[last] - begins[first] - gap))
            deep += float(depths[first:last].max()) + gap
            first = last
        deep -= gap
        aspect = max(wide, THIN) / max(deep, THIN)
        cost = (wide + gap) * (deep + gap) * max(aspect / ASPECT, ASPECT / aspect) ** 0.7
        if cost < best[0] - 1e-9:
            best = (cost, rows)
    return best[1]


def _row_widths(begins: Floats, gap: float, widest: float, whole: float, count: int) -> list[float]:
    if count <= FEW:
        # Every width at which some row is just full; equal ones differ by what rounding left.
        runs = (begins[None, :] - begins[:, None] - gap)[np.triu_indices(count + 1, 1)]
        return sorted({max(round(width, 9), widest) for width in runs.tolist()}, reverse=True)
    square = np.sqrt(whole * widest)
    return [
        float(width)
        for width in np.geomspace(whole, widest, TRIES)
        if square / 8 <= width <= square * 8 or width in (whole, widest)
    ]


def _stand(sizes: Sequence[tuple[float, float]], rows: Sequence[int], gap: float) -> Arranged:
    depths = []
    widths = []
    first = 0
    for count in rows:
        row = sizes[first : first + count]
        widths.append(sum(size[0] for size in row) + gap * (count - 1))
        depths.append(max(size[1] for size in row))
        first += count
    width = max(widths)
    depth = sum(depths) + gap * (len(rows) - 1)
    centers: list[tuple[float, float]] = []
    row_depths: list[float] = []
    first = 0
    back = depth / 2
    for count, row_width, row_depth in zip(rows, widths, depths, strict=True):
        left = -row_width / 2
        for size in sizes[first : first + count]:
            centers.append((left + size[0] / 2, back - row_depth / 2))
            row_depths.append(row_depth)
            left += size[0] + gap
        first += count
        back -= row_depth + gap
    return Arranged(tuple(centers), tuple(row_depths), width, depth)
