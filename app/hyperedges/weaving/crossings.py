"""Which hyperedges come too near to each other as seen from above (Numba)."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.stopping import unchecked

MARGIN = 1.02
"""Plans count as crossing up to this many times the distance that tubes need."""

AT_ONCE = 2048
"""Legs between two looks whether to go on."""


class Crossings(NamedTuple):
    """Which plans of h hyperedges come too near to each other.

    The neighbours of hyperedge k are ``neighbours[starts[k] : starts[k + 1]]``, in order.
    """

    starts: Indices
    neighbours: Indices


def find_crossings(
    legs: Floats,
    owners: Indices,
    still_legs: Floats,
    still_owners: Indices,
    radii: Floats,
    clearance: float,
    check: Callable[[], None] = unchecked,
) -> Crossings:
    """Crossings of straight legs (m, 2, 2) with each other and with those that stand still.

    Those are (n, 2, 2); among themselves they do not count. ``owners`` (m,) and ``still_owners``
    (n,) are their hyperedges. Tubes with ``radii`` (h,) need r1 + r2 + ``clearance`` between their
    centre lines. ``check`` is called now and then, and may raise to end it.
    """
    order = np.argsort(legs[:, :, 0].min(axis=1), kind="stable")
    sorted_legs, sorted_owners = legs[order], owners[order]
    parts = []
    for begin in range(0, len(legs), AT_ONCE):
        check()
        end = min(begin + AT_ONCE, len(legs))
        parts.append(_sweep(begin, end, sorted_legs, sorted_owners, radii, clearance))
    check()
    parts.append(_compare(legs, owners, still_legs, still_owners, radii, clearance))
    pairs = np.concatenate(parts)
    count = len(radii)
    codes = np.sort(
        np.concatenate([pairs[:, 0] * count + pairs[:, 1], pairs[:, 1] * count + pairs[:, 0]])
    )
    codes = codes[np.diff(codes, prepend=-1) > 0]
    first, second = codes // count, codes % count
    return Crossings(np.searchsorted(first, np.arange(count + 1)), second)


@njit(cache=True)
def _sweep(
    first: int, last: int, legs: Floats, owners: Indices, radii: Floats, clearance: float
) -> Indices:
    """Pairs of hyperedges with legs too near, some of them several times; legs sorted by x.

    One of each is among the legs from ``first`` to ``last``, the other behind it.
    """
    pairs = np.empty((4 * (last - first) + 16, 2), np.int64)
    count = 0
    widest = 0.0
    for r in radii:
        widest = max(widest, r)
    # Remembers with whom a hyperedge was last paired, which saves most repetitions.
    lately = np.full(len(radii), -1)
    for i in range(first, last):
        k = owners[i]
        right = max(legs[i, 0, 0], legs[i, 1, 0]) + MARGIN * (radii[k] + widest + clearance)
        low = min(legs[i, 0, 1], legs[i, 1, 1])
        high = max(legs[i, 0, 1], legs[i, 1, 1])
        for j in range(i + 1, len(legs)):
            if min(legs[j, 0, 0], legs[j, 1, 0]) > right:
                break
            other = owners[j]
            if other == k or lately[other] == i:
                continue
            needed = MARGIN * (radii[k] + radii[other] + clearance)
            if min(legs[j, 0, 1], legs[j, 1, 1]) > high + needed:
                continue
            if max(legs[j, 0, 1], legs[j, 1, 1]) < low - needed:
                continue
            if squared_gap(legs[i], legs[j]) >= needed * needed:
                continue
            lately[other] = i
            if count == len(pairs):
                more = np.empty((2 * count, 2), np.int64)
                more[:count] = pairs
                pairs = more
            pairs[count, 0], pairs[count, 1] = k, other
            count += 1
    return pairs[:count]


@njit(cache=True)
def _compare(
    legs: Floats,
    owners: Indices,
    others: Floats,
    other_owners: Indices,
    radii: Floats,
    clearance: float,
) -> Indices:
    """Pairs of hyperedges of which a leg of each list are too near."""
    pairs = np.empty((64, 2), np.int64)
    count = 0
    for j in range(len(others)):
        low_x, high_x = min(others[j, 0, 0], others[j, 1, 0]), max(others[j, 0, 0], others[j, 1, 0])
        low_y, high_y = min(others[j, 0, 1], others[j, 1, 1]), max(others[j, 0, 1], others[j, 1, 1])
        for i in range(len(legs)):
            needed = MARGIN * (radii[owners[i]] + radii[other_owners[j]] + clearance)
            if min(legs[i, 0, 0], legs[i, 1, 0]) > high_x + needed:
                continue
            if max(legs[i, 0, 0], legs[i, 1, 0]) < low_x - needed:
                continue
            if min(legs[i, 0, 1], legs[i, 1, 1]) > high_y + needed:
                continue
            if max(legs[i, 0, 1], legs[i, 1, 1]) < low_y - needed:
                continue
            if squared_gap(legs[i], others[j]) >= needed * needed:
                continue
            if count == len(pairs):
                more = np.empty((2 * count, 2), np.int64)
                more[:count] = pairs
                pairs = more
            pairs[count, 0], pairs[count, 1] = owners[i], other_owners[j]
            count += 1
    return pairs[:count]


@njit(cache=True)
def squared_gap(a: Floats, b: Floats) -> float:
    """Squared distance of two straight legs (2, 2); zero where they cross."""
    if _side(a, b[0]) * _side(a, b[1]) < 0.0 and _side(b, a[0]) * _side(b, a[1]) < 0.0:
        return 0.0
    return min(
        squared_distance(a, b[0]),
        squared_distance(a, b[1]),
        squared_distance(b, a[0]),
        squared_distance(b, a[1]),
    )


@njit(cache=True)
def _side(leg: Floats, point: Floats) -> float:
    return float(
        (leg[1, 0] - leg[0, 0]) * (point[1] - leg[0, 1])
        - (leg[1, 1] - leg[0, 1]) * (point[0] - leg[0, 0])
    )


@njit(cache=True)
def squared_distance(leg: Floats, point: Floats) -> float:
    """Squared distance of a point (2,) from a straight leg (2, 2)."""
    x, y = leg[1, 0] - leg[0, 0], leg[1, 1] - leg[0, 1]
    square = x * x + y * y
    t = 0.0
    if square > 0.0:
        t = ((point[0] - leg[0, 0]) * x + (point[1] - leg[0, 1]) * y) / square
        t = min(max(t, 0.0), 1.0)
    dx, dy = leg[0, 0] + t * x - point[0], leg[0, 1] + t * y - point[1]
    return float(dx * dx + dy * dy)
