"""The search for the smallest distance: pieces are halved where they may be nearest (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.clearance.cubic import SLACK
from app.hyperedges.clearance.curve_and_box import halve_before_box, look_at_box
from app.hyperedges.clearance.heap import drop_first, push
from app.hyperedges.clearance.two_curves import COLUMNS, halve_either, look_at_curves

ROWS = 512
"""Pieces that can wait. Where they do not suffice the lower bound is true, but loose."""

STEPS = 4096
"""Pieces halved, at most, in one search."""

DECIDED = 1e-6
"""Of ``enough``: bounds on both sides of it that are so near to each other are left at that."""


@njit(cache=True, error_model="numpy", nogil=True)
def workspace() -> tuple[Floats, Floats, Indices, Indices]:
    """Room for one search at a time: rows, their keys, the heap, and rows to be used again."""
    return (
        np.empty((ROWS, COLUMNS)),
        np.empty(ROWS),
        np.empty(ROWS, np.int64),
        np.empty(ROWS, np.int64),
    )


@njit(cache=True, error_model="numpy", nogil=True)
def narrow(
    boxed: bool,
    enough: float,
    thickness: float,
    tolerance: float,
    least: float,
    rows: Floats,
    keys: Floats,
    heap: Indices,
    free: Indices,
) -> tuple[float, float, float, float]:
    """Bounds of the distance between what row 0 holds: two curves, or a curve and a box.

    Returns lower, upper, and where on the first and the second curve (0 for a box) upper is
    reached. The row with the smallest lower bound is halved first. It ends when lower is at least
    ``enough``; or when upper is below ``enough`` and upper - lower at most ``tolerance`` times what
    upper differs from ``thickness``, or at most ``least``; or after bounded work.
    """
    upper, best_u, best_v = np.inf, 0.0, 0.0
    dropped = np.inf
    waiting, used, spare = 0, 1, 0
    first, second = 0, -1
    for _ in range(STEPS):
        for row in (first, second):
            if row < 0:
                continue
            v = 0.0
            if boxed:
                key, here, u = look_at_box(rows, row, upper)
            else:
                key, here, u, v = look_at_curves(rows, row, upper)
            if here < upper:
                upper, best_u, best_v = here, u, v
            if key >= enough or key >= upper:
                dropped = min(dropped, key)
                free[spare] = row
                spare += 1
            else:
                keys[row] = key
                push(heap, waiting, keys, row)
                waiting += 1
        if waiting == 0:
            break
        first = heap[0]
        if _suffices(min(keys[first], dropped), upper, enough, thickness, tolerance, least):
            break
        if spare == 0 and used == ROWS:
            break
        drop_first(heap, waiting, keys)
        waiting -= 1
        if spare > 0:
            spare -= 1
            second = free[spare]
        else:
            second = used
            used += 1
        if boxed:
            halve_before_box(rows, first, second)
        else:
            halve_either(rows, first, second)
    lower = dropped if waiting == 0 else min(dropped, keys[heap[0]])
    return max(lower, 0.0), upper, best_u, best_v


@njit(cache=True, error_model="numpy")
def _suffices(
    lower: float, upper: float, enough: float, thickness: float, tolerance: float, least: float
) -> bool:
    room = upper - max(lower, 0.0)
    if room <= 8.0 * SLACK:
        return True
    if upper >= enough:
        return room <= DECIDED * enough
    return room <= least or room <= tolerance * abs(upper - thickness)
