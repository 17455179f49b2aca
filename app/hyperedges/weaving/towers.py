"""How high hyperedges must run to pass above the items under their plans (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.clearance.obstacles import Obstacles


def pass_above(
    legs: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    obstacles: Obstacles,
    lows: Floats,
) -> Floats:
    """``lows`` (h,), raised to where straight ``legs`` (m, 2, 2) clear all that is below them.

    ``owners`` (m,) are the legs' hyperedges, with tubes of ``radii`` (h,).
    """
    if len(obstacles.centers) == 0 or len(legs) == 0:
        return lows
    reach = np.einsum("mij,mj->mi", np.abs(obstacles.rotations), obstacles.halves)
    reach += obstacles.roundings[:, None]
    boxes = np.concatenate(
        [obstacles.centers[:, :2] - reach[:, :2], obstacles.centers[:, :2] + reach[:, :2]], axis=1
    )
    tops = obstacles.centers[:, 2] + reach[:, 2]
    order = np.argsort(boxes[:, 0], kind="stable")
    widest = float((boxes[:, 2] - boxes[:, 0]).max())
    return _raise(legs, owners, radii, clearance, boxes[order], tops[order], widest, lows)


@njit(cache=True)
def _raise(
    legs: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    boxes: Floats,
    tops: Floats,
    widest: float,
    lows: Floats,
) -> Floats:
    """The same for ``boxes`` (n, 4), smallest and largest x and y, sorted by smallest x."""
    raised = lows.copy()
    for i in range(len(legs)):
        k = owners[i]
        margin = radii[k] + clearance
        left = min(legs[i, 0, 0], legs[i, 1, 0]) - margin
        right = max(legs[i, 0, 0], legs[i, 1, 0]) + margin
        for j in range(np.searchsorted(boxes[:, 0], left - widest), len(boxes)):
            if boxes[j, 0] > right:
                break
            top = tops[j] + 1.01 * margin
            if top > raised[k] and _meets(legs[i], boxes[j], margin):
                raised[k] = top
    return raised


@njit(cache=True)
def _meets(leg: Floats, box: Floats, margin: float) -> bool:
    """Whether a leg comes into a box with a margin all around."""
    low, high = 0.0, 1.0
    for axis in range(2):
        start, run = leg[0, axis], leg[1, axis] - leg[0, axis]
        near, far = box[axis] - margin, box[axis + 2] + margin
        if run == 0.0:
            if start < near or start > far:
                return False
        else:
            first, second = (near - start) / run, (far - start) / run
            low, high = max(low, min(first, second)), min(high, max(first, second))
    return low <= high
