"""How far two cubics, or a cubic and a box, are from each other: between two bounds (Numba)."""

from __future__ import annotations

from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.clearance.curve_and_box import place_before_box
from app.hyperedges.clearance.search import narrow, workspace
from app.hyperedges.clearance.two_curves import place_curves


@njit(cache=True, error_model="numpy", nogil=True)
def bounds(
    p: Floats, q: Floats, enough: float, tolerance: float
) -> tuple[float, float, float, float]:
    """Bounds of the smallest distance of two cubics (4, 3), and where the upper one is reached.

    Returns lower, upper, and the parameters u on ``p`` and v on ``q`` whose points are no farther
    apart than upper. It ends when lower is at least ``enough``, or when upper is below ``enough``
    and upper - lower at most ``tolerance`` times upper; or after bounded work, when lower is still
    a lower bound, but a loose one (curves that lie on each other, or nearly, over some length).
    """
    return search(p, q, enough, 0.0, tolerance, 0.0, *workspace())


@njit(cache=True, error_model="numpy", nogil=True)
def search(
    p: Floats,
    q: Floats,
    enough: float,
    thickness: float,
    tolerance: float,
    least: float,
    rows: Floats,
    keys: Floats,
    heap: Indices,
    free: Indices,
) -> tuple[float, float, float, float]:
    """As `bounds`, in a `workspace`, where ``thickness`` of the distance is inside the tubes.

    It ends also when upper - lower is at most ``tolerance`` times upper - ``thickness``, or
    ``least``, instead of ``tolerance`` times upper.
    """
    scale = place_curves(p, q, rows)
    lower, upper, u, v = narrow(
        False,
        enough / scale,
        thickness / scale,
        tolerance,
        least / scale,
        rows,
        keys,
        heap,
        free,
    )
    return lower * scale, upper * scale, u, v


@njit(cache=True, error_model="numpy", nogil=True)
def search_box(
    p: Floats,
    center: Floats,
    rotation: Floats,
    half: Floats,
    enough: float,
    thickness: float,
    tolerance: float,
    least: float,
    rows: Floats,
    keys: Floats,
    heap: Indices,
    free: Indices,
) -> tuple[float, float, float]:
    """As `search` for a cubic and a box, without a place on the box: lower, upper, u.

    The box has its ``center`` (3,), the columns of ``rotation`` (3, 3) as axes, and ``half`` (3,)
    its sizes. The distance from a place within it is 0.
    """
    scale = place_before_box(p, center, rotation, half, rows)
    lower, upper, u, _ = narrow(
        True,
        enough / scale,
        thickness / scale,
        tolerance,
        least / scale,
        rows,
        keys,
        heap,
        free,
    )
    return lower * scale, upper * scale, u
