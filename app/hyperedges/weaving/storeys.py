"""Planes for hyperedges whose plans cross: as few and as low as can be (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.weaving.crossings import Crossings, squared_distance

APART = 1.02
"""Planes of crossing hyperedges are this many times as far apart as their tubes need."""


@njit(cache=True)
def first_fit(
    crossings: Crossings,
    order: Indices,
    lows: Floats,
    tops: Floats,
    radii: Floats,
    clearance: float,
) -> Floats:
    """Planes (h,): one hyperedge of ``order`` after another takes the lowest that is free.

    None is below ``lows`` (h,); one that finds nothing up to its top (h,) stays at its low, in the
    way of others. Hyperedges that are not in ``order`` stay at their ``lows``.
    """
    planes = lows.copy()
    given = np.ones(len(lows), np.bool_)
    given[order] = False
    for k in order:
        near = crossings.neighbours[crossings.starts[k] : crossings.starts[k + 1]]
        below = np.empty(len(near))
        above = np.empty(len(near))
        count = 0
        for other in near:
            if given[other]:
                needed = APART * (radii[k] + radii[other] + clearance)
                below[count] = planes[other] - needed
                above[count] = planes[other] + needed
                count += 1
        for i in np.argsort(below[:count]):
            if below[i] < planes[k] - 1e-9 and planes[k] < above[i] - 1e-9:
                planes[k] = above[i]
        if planes[k] > tops[k]:
            planes[k] = lows[k]
        given[k] = True
    return planes


@njit(cache=True)
def stack(
    crossings: Crossings,
    order: Indices,
    lows: Floats,
    fixed: NDArray[np.bool_],
    radii: Floats,
    clearance: float,
) -> Floats:
    """Planes (h,), lowest first: each above all that it crosses and that come before it.

    Those that are ``fixed`` (h,) stay at their ``lows`` (h,).
    """
    planes = lows.copy()
    given = np.zeros(len(lows), np.bool_)
    for k in order:
        for other in crossings.neighbours[crossings.starts[k] : crossings.starts[k + 1]]:
            if given[other] and not fixed[k]:
                needed = APART * (radii[k] + radii[other] + clearance)
                planes[k] = max(planes[k], planes[other] + needed)
        given[k] = True
    return planes


@njit(cache=True)
def highest_under(
    legs: Floats,
    leg_owners: Indices,
    feet: Floats,
    feet_owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
    count: int,
) -> Floats:
    """How high the first ``count`` hyperedges may be at most, because others pass over their feet.

    ``legs`` (m, 2, 2) of ``leg_owners`` (m,), at the height of their ``planes`` (h,); ``feet``
    (a, 2) of ``feet_owners`` (a,).
    """
    tops = np.full(len(planes), np.inf)
    for i in range(len(feet)):
        k = feet_owners[i]
        if k >= count:
            continue
        for leg in range(len(legs)):
            other = leg_owners[leg]
            needed = radii[k] + radii[other] + clearance
            if tops[k] > planes[other] - needed and (
                squared_distance(legs[leg], feet[i]) < needed * needed
            ):
                tops[k] = planes[other] - needed
    return tops
