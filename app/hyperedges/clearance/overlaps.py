"""Items that stand in each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.placement.placement import Placement

MOST = 1000
"""Pairs that are named; whoever piles up all items gets no list of all pairs."""

TOUCHING = 1e-6
"""Of the extent of both boxes: what is no deeper stands on or beside the other."""


@dataclass(frozen=True, slots=True, eq=False)
class Overlaps:
    """Pairs (k, 2) of items, smaller number first, sorted, and how deep they overlap (k,).

    The depth is how far one of them has to move, in document units, for their boxes to part.
    """

    items: Indices
    depths: Floats


def find_overlaps(placement: Placement) -> Overlaps:
    """The items that overlap, at most `MOST` pairs; none with what contains it, at any depth.

    Items are the boxes of `app.hyperedges.clearance.hulls`.
    """
    bodies = obstacles_of(placement).bodies
    parents = placement.parents
    if len(parents) != len(placement.centers):
        parents = np.full(len(placement.centers), -1)
    reach = np.einsum("kij,kj->ki", np.abs(bodies.rotations), bodies.halves)
    reach += bodies.roundings[:, None]
    lows, highs = bodies.centers - reach, bodies.centers + reach
    if len(lows) == 0:
        return Overlaps(np.zeros((0, 2), dtype=np.int64), np.zeros(0))
    # Along the axis on which they are spread most, the fewest are beside each other.
    axis = int(np.argmax(np.std((lows + highs) / 2, axis=0)))
    order = np.argsort(lows[:, axis], kind="stable")
    pairs, depths = _sweep(bodies, order, lows, highs, axis, parents)
    keys = pairs[:, 0] * len(parents) + pairs[:, 1]
    found, rows = np.unique(keys, return_inverse=True)
    deepest = np.zeros(len(found))
    np.maximum.at(deepest, rows, depths)
    return Overlaps(np.stack(np.divmod(found, len(parents)), axis=1), deepest)


def _sweep(
    bodies: Obstacles, order: Indices, lows: Floats, highs: Floats, axis: int, parents: Indices
) -> tuple[Indices, Floats]:
    return _collect(
        order,
        lows,
        highs,
        axis,
        bodies.centers,
        bodies.rotations,
        bodies.halves,
        bodies.roundings,
        bodies.items,
        parents,
    )


@njit(cache=True, error_model="numpy")
def _collect(
    order: Indices,
    lows: Floats,
    highs: Floats,
    axis: int,
    centers: Floats,
    rotations: Floats,
    halves: Floats,
    roundings: Floats,
    items: Indices,
    parents: Indices,
) -> tuple[Indices, Floats]:
    """Boxes that overlap, by a sweep along an axis; it ends when there are `MOST`."""
    pairs, depths, count = np.empty((MOST, 2), np.int64), np.empty(MOST), 0
    for place in range(len(order)):
        i = order[place]
        for other in range(place + 1, len(order)):
            j = order[other]
            if lows[j, axis] >= highs[i, axis]:
                break
            apart = items[i] == items[j]
            for side in range(3):
                apart |= lows[j, side] >= highs[i, side] or lows[i, side] >= highs[j, side]
            if apart or _contains(items[i], items[j], parents):
                continue
            depth = _depth(centers, rotations, halves, roundings, i, j)
            extent = 0.0
            for side in range(3):
                extent = max(extent, highs[i, side] - lows[i, side], highs[j, side] - lows[j, side])
            if depth <= TOUCHING * extent:
                continue
            pairs[count, 0], pairs[count, 1] = min(items[i], items[j]), max(items[i], items[j])
            depths[count] = depth
            count += 1
            if count == MOST:
                return pairs, depths
    return pairs[:count].copy(), depths[:count].copy()


@njit(cache=True, error_model="numpy")
def _contains(one: int, other: int, parents: Indices) -> bool:
    """Whether one of two items contains the other, at any depth."""
    for inner, outer in ((one, other), (other, one)):
        above = parents[inner]
        while above >= 0 and above != outer:
            above = parents[above]
        if above == outer:
            return True
    return False


@njit(cache=True, error_model="numpy")
def _depth(
    centers: Floats, rotations: Floats, halves: Floats, roundings: Floats, i: int, j: int
) -> float:
    """How deep two rounded boxes are in each other, along the best of all axes that can part them.

    Of two boxes these are the axes of both and their cross products (Gottschalk, Lin and Manocha
    1996); of a ball and anything else also the line from the ball to its nearest place.
    """
    ways = np.zeros((17, 3))
    for k in range(3):
        ways[k], ways[3 + k] = rotations[i, :, k], rotations[j, :, k]
        for m in range(3):
            ways[6 + 3 * k + m] = np.cross(rotations[i, :, k], rotations[j, :, m])
    for row, ball, box in ((15, i, j), (16, j, i)):
        if halves[ball].max() == 0.0:
            for k in range(3):
                away = 0.0
                for m in range(3):
                    away += (centers[ball, m] - centers[box, m]) * rotations[box, m, k]
                beyond = away - min(max(away, -halves[box, k]), halves[box, k])
                for m in range(3):
                    ways[row, m] += beyond * rotations[box, m, k]
    least = np.inf
    for row in range(17):
        length = np.sqrt((ways[row] ** 2).sum())
        if length < 1e-9:
            continue
        between, reach = 0.0, roundings[i] + roundings[j]
        for k in range(3):
            between += (centers[j, k] - centers[i, k]) * ways[row, k] / length
            for box in (i, j):
                along = 0.0
                for m in range(3):
                    along += rotations[box, m, k] * ways[row, m] / length
                reach += halves[box, k] * abs(along)
        least = min(least, reach - abs(between))
    return least
