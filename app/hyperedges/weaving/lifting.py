"""Arches that clear each other by their heights alone, as long as there are not too many."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats
from app.hyperedges.stopping import unchecked
from app.hyperedges.weaving.courses import SOFT
from app.hyperedges.weaving.loom import Check, Loom
from app.hyperedges.weaving.ways import Ways

ROUNDS = 8

CROWDED = 1.5
"""With more pairs than this for each hyperedge too near, lifting is not tried."""

LIMIT = 1.0
"""How far a hyperedge is lifted at most, over its height above its attachments."""

STEP = 1.6
"""How far one is lifted, over what is lacking: arches rise less beside their tops."""


def lift(
    loom: Loom,
    planes: Floats,
    fixed: NDArray[np.bool_],
    check: Callable[[], None] = unchecked,
) -> Floats:
    """Planes (h,) raised where one soft arch passes too closely above another.

    Those that are ``fixed`` (h,) are not. What is above the other there rises.
    ``check`` is called now and then, and may raise to end it.
    """
    count = len(loom.owners)
    soft = np.full(count, SOFT)
    nowhere = Ways(np.zeros(count + 1, np.int64), np.zeros((0, 2)), np.zeros(count, np.bool_))
    threads = loom.threads
    lifted = planes.copy()
    highest = np.full(len(planes), np.inf)
    if len(threads.radii):
        tops = np.maximum.reduceat(threads.positions[:, 2], threads.starts[:-1])
        rises = planes[: len(tops)] - tops
        highest[: len(tops)] = planes[: len(tops)] + LIMIT * rises
    highest[fixed] = -np.inf
    active = np.ones(count, dtype=np.bool_)
    for _ in range(ROUNDS):
        found = loom.check(loom.lay(nowhere, soft, lifted), active, check)
        if len(found.near) == 0 or len(found.near) > CROWDED * len(threads.radii):
            break
        rise = _rises(found, len(planes))
        rise[lifted + rise > highest] = 0.0
        if not rise.any():
            break
        lifted += rise
        active = (rise > 0.0)[loom.owners]
    return lifted


def _rises(check: Check, count: int) -> Floats:
    """By how much each hyperedge (h,) shall rise."""
    faults = check.faults
    first_above = faults.heights[:, 0] > faults.heights[:, 1]
    above = np.where(first_above, check.hyperedges[:, 0], check.hyperedges[:, 1])
    rise = np.zeros(count)
    np.maximum.at(rise, above, STEP * faults.depths)
    return rise
