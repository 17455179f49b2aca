"""How near hyperedges come to obstacles."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.box_tree import meeting, plant
from app.hyperedges.clearance.distance import search_box
from app.hyperedges.clearance.few_boxes import FEW, meeting_with
from app.hyperedges.clearance.obstacles import Obstacles
from app.hyperedges.clearance.pairs import FINEST, ROUNDING, Gaps, bezier, boxes
from app.hyperedges.clearance.parallel import in_parts
from app.hyperedges.clearance.passable import are_among
from app.hyperedges.clearance.search import workspace


def near_obstacles(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    obstacles: Obstacles,
    passable: Indices,
    clearance: float,
    active: Flags | None = None,
) -> Indices:
    """Pairs (m, 2) of a segment and a box of an obstacle that may be nearer than ``clearance``.

    ``control_points`` (s, 4, 3), ``owners`` and ``radii`` (s,) of the segments, as for
    `app.hyperedges.clearance.pairs.near_pairs`. No hyperedge is paired with an item that
    ``passable`` (k, 2), sorted, names it with, nor with that item's label. With ``active`` (s,)
    those segments alone. Sorted.
    """
    if len(control_points) == 0 or len(obstacles.items) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    asking = np.arange(len(owners)) if active is None else np.flatnonzero(active)
    if len(asking) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    ours = boxes(control_points[asking], radii[asking] + clearance)
    all_theirs = _boxes_around(obstacles)
    meets = (all_theirs[:, :3] <= ours[:, 4:7].max(axis=0)) & (
        all_theirs[:, 4:7] >= ours[:, :3].min(axis=0)
    )
    within_reach = np.flatnonzero(meets[:, 0] & meets[:, 1] & meets[:, 2])
    if len(within_reach) == 0:
        return np.zeros((0, 2), dtype=np.int64)
    theirs, numbers = all_theirs[within_reach], np.arange(len(asking))
    if len(asking) * len(theirs) <= FEW:
        found = meeting_with(ours, numbers, theirs)
    else:
        # No two groups are equal: the pairs that are passable are taken out below.
        strangers = np.full(len(theirs), -1)
        found = meeting(plant(theirs), ours, numbers, (owners[asking], strangers))
    found = np.stack([asking[found[:, 0]], within_reach[found[:, 1]]], axis=1)
    named = np.stack([owners[found[:, 0]], obstacles.items[found[:, 1]]], axis=1)
    return np.asarray(found[~are_among(named, passable)])


@lru_cache(maxsize=4)
def _boxes_around(obstacles: Obstacles) -> Floats:
    """Boxes (m, 8) along the axes around those of obstacles, as `meeting` takes them."""
    reach = np.einsum("kij,kj->ki", np.abs(obstacles.rotations), obstacles.halves)
    reach += (obstacles.roundings + ROUNDING * float(np.abs(obstacles.centers).max()))[:, None]
    nothing = np.zeros((len(obstacles.items), 1))
    return np.hstack([obstacles.centers - reach, nothing, obstacles.centers + reach, nothing])


def obstacle_gaps(
    control_points: Floats,
    radii: Floats,
    obstacles: Obstacles,
    pairs: Indices,
    enough: float,
    tolerance: float = 0.01,
) -> Gaps:
    """How far the tubes of ``pairs`` (m, 2) of a segment and a box of an obstacle are from it.

    As `app.hyperedges.clearance.pairs.gaps`; the second of ``at`` is 0. A curve that enters a box
    has the distance -radius, however deep it goes.
    """
    count = len(pairs)
    found = Gaps(np.empty(count), np.empty(count), np.zeros((count, 2)), np.empty((count, 3)))
    in_parts(
        count,
        lambda begin, end: _measure(
            control_points,
            radii,
            obstacles.centers,
            obstacles.rotations,
            obstacles.halves,
            obstacles.roundings,
            pairs[begin:end],
            enough,
            tolerance,
            found.lower[begin:end],
            found.upper[begin:end],
            found.at[begin:end],
            found.places[begin:end],
        ),
    )
    return found


@njit(cache=True, error_model="numpy", nogil=True)
def _measure(
    control_points: Floats,
    radii: Floats,
    centers: Floats,
    rotations: Floats,
    halves: Floats,
    roundings: Floats,
    pairs: Indices,
    enough: float,
    tolerance: float,
    lower: Floats,
    upper: Floats,
    at: Floats,
    places: Floats,
) -> None:
    rows, keys, heap, free = workspace()
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        thickness = radii[i] + roundings[j]
        near, far, u = search_box(
            control_points[i],
            centers[j],
            rotations[j],
            halves[j],
            enough + thickness,
            thickness,
            tolerance,
            FINEST * tolerance * thickness,
            rows,
            keys,
            heap,
            free,
        )
        lower[k], upper[k] = near - thickness, far - thickness
        at[k, 0] = u
        for axis in range(3):
            places[k, axis] = bezier(control_points, i, axis, u)
        # From the curve over its radius and half the gap.
        if far > 0.0:
            _go_to_box(
                centers[j],
                rotations[j],
                halves[j],
                (radii[i] + 0.5 * (far - thickness)) / far,
                places[k],
            )


@njit(cache=True, error_model="numpy")
def _go_to_box(center: Floats, rotation: Floats, half: Floats, share: float, place: Floats) -> None:
    """Move a place a share of the way to the nearest point of a box."""
    way = np.zeros(3)
    for axis in range(3):
        along = 0.0
        for other in range(3):
            along += (place[other] - center[other]) * rotation[other, axis]
        beyond = along - min(max(along, -half[axis]), half[axis])
        for other in range(3):
            way[other] -= beyond * rotation[other, axis]
    for axis in range(3):
        place[axis] += share * way[axis]
