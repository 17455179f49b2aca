"""Courses that are made stricter until they keep clear, and what wants a higher plane."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.weaving.courses import AROUND, SOFT, STEEP
from app.hyperedges.weaving.fabric import Fabric
from app.hyperedges.weaving.loom import Check, Loom
from app.hyperedges.weaving.ways import Ways


def harden(
    loom: Loom, ways: Ways, planes: Floats, check: Callable[[], None]
) -> tuple[Fabric, Check]:
    """Courses that are made stricter where they are too near to something, and what that leaves.

    Of two that are too near the softer one is made stricter, or both. ``check`` is called now and
    then, and may raise to end it.
    """
    count = len(loom.owners)
    strictness = np.full(count, SOFT)
    active = np.ones(count, dtype=np.bool_)
    while True:
        fabric = loom.lay(ways, strictness, planes)
        found = loom.check(fabric, active, check)
        level = np.append(strictness, AROUND)
        first, second = level[found.near].T
        softer = np.zeros(count + 1, dtype=np.bool_)
        softer[found.near[first <= second, 0]] = True
        softer[found.near[second <= first, 1]] = True
        softer[found.at_items] = True
        changed = softer[:-1] & (strictness < AROUND)
        # Going around nothing does not unbend an edge.
        changed |= found.pinched & (strictness < STEEP)
        if not changed.any():
            return fabric, found
        strictness[changed] += 1
        active = changed | (found.edges & (strictness == AROUND))


def troubled_threads(
    check: Check, wrong: NDArray[np.bool_], edges: Indices, planes: Floats, woven: int
) -> Indices:
    """Threads with edges that are ``wrong`` (e,), and the lower ones of those that are too near."""
    first, second = check.hyperedges.T
    lower = np.where(planes[first] <= planes[second], first, second)
    upper = np.where(planes[first] <= planes[second], second, first)
    found = np.where(lower < woven, lower, upper)
    return np.unique(np.concatenate([found, edges[wrong]]))
