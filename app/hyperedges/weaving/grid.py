"""Places in the plane sorted into square cells, to find those near a line (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices

MOST_CELLS = 4
"""Cells for each place, at most, however far apart the places are."""


class Grid(NamedTuple):
    """Numbers of places (n, 2) by cell: ``members[starts[c] : starts[c + 1]]`` lie in cell c.

    Cell c is column c // ``rows`` and row c % ``rows`` of cells of size ``cell`` from ``corner``.
    """

    corner: tuple[float, float]
    cell: float
    columns: int
    rows: int
    starts: Indices
    members: Indices


def sort_into_cells(places: Floats, wished: float) -> Grid:
    """Places (n, 2) in cells of size ``wished``, or larger where that makes too many."""
    if len(places) == 0:
        return Grid((0.0, 0.0), 1.0, 1, 1, np.zeros(2, np.int64), np.zeros(0, np.int64))
    low, high = places.min(axis=0), places.max(axis=0)
    extent = high - low
    cell = max(wished, float(extent.max()) * 1e-6, 1e-9)
    room = MOST_CELLS * len(places) + 16
    while (int(extent[0] / cell) + 1) * (int(extent[1] / cell) + 1) > room:
        cell *= 1.5
    columns, rows = int(extent[0] / cell) + 1, int(extent[1] / cell) + 1
    cells = ((places - low) / cell).astype(np.int64)
    numbers = np.minimum(cells[:, 0], columns - 1) * rows + np.minimum(cells[:, 1], rows - 1)
    members = np.argsort(numbers, kind="stable")
    starts = np.searchsorted(numbers[members], np.arange(columns * rows + 1))
    return Grid((float(low[0]), float(low[1])), cell, columns, rows, starts, members)


@njit(cache=True)
def collect(
    grid: Grid, ax: float, ay: float, bx: float, by: float, reach: float, found: Indices
) -> int:
    """How many places lie in cells nearer than ``reach`` to the line from a to b.

    Writes their numbers to ``found``, as many as it has room for, in the order of the cells.
    """
    count = 0
    low = int(np.floor((min(ax, bx) - reach - grid.corner[0]) / grid.cell))
    high = int(np.floor((max(ax, bx) + reach - grid.corner[0]) / grid.cell))
    for column in range(max(low, 0), min(high, grid.columns - 1) + 1):
        left = grid.corner[0] + column * grid.cell - reach
        right = left + grid.cell + 2.0 * reach
        from_y, to_y = _within(ax, ay, bx, by, left, right)
        if from_y > to_y:
            continue
        below = int(np.floor((from_y - reach - grid.corner[1]) / grid.cell))
        above = int(np.floor((to_y + reach - grid.corner[1]) / grid.cell))
        for row in range(max(below, 0), min(above, grid.rows - 1) + 1):
            number = column * grid.rows + row
            for m in range(grid.starts[number], grid.starts[number + 1]):
                if count < len(found):
                    found[count] = grid.members[m]
                    count += 1
    return count


@njit(cache=True)
def _within(
    ax: float, ay: float, bx: float, by: float, left: float, right: float
) -> tuple[float, float]:
    """The smallest and largest y of the line from a to b where x is between left and right."""
    if max(ax, bx) < left or min(ax, bx) > right:
        return 1.0, 0.0
    low, high = 0.0, 1.0
    run = bx - ax
    if run != 0.0:
        first, second = (left - ax) / run, (right - ax) / run
        low, high = max(low, min(first, second)), min(high, max(first, second))
    if low > high:
        return 1.0, 0.0
    first, second = ay + low * (by - ay), ay + high * (by - ay)
    return min(first, second), max(first, second)
