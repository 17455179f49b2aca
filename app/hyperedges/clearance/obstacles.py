"""Items as obstacles for hyperedges that do not attach to them, and how near these come."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.box_tree import in_parts, meeting, plant
from app.hyperedges.clearance.distance import search_box
from app.hyperedges.clearance.few_boxes import FEW, meeting_with
from app.hyperedges.clearance.hulls import hull
from app.hyperedges.clearance.pairs import FINEST, ROUNDING, Gaps, bezier, boxes
from app.hyperedges.clearance.passable import are_among
from app.hyperedges.clearance.search import workspace
from app.placement.placement import LabelPlace, Placement
from app.placement.turning import matrices
from app.solids.solid import Size, Solid


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """m rounded boxes that hold all items and their labels.

    ``centers`` (m, 3); the columns of ``rotations`` (m, 3, 3) are the boxes' axes; ``halves``
    (m, 3) half their sizes; ``roundings`` (m,): all that is nearer to a box than this belongs to it
    (a ball is a box without size). ``items`` (m,): whose they are, ascending; ``is_label`` (m,):
    whether they hold an item's label instead of its body.
    """

    centers: Floats
    rotations: Floats
    halves: Floats
    roundings: Floats
    items: Indices
    is_label: NDArray[np.bool_]

    @property
    def bodies(self) -> Obstacles:
        """The boxes of the items themselves, without their labels: always the same arrays."""
        return _bodies(self)

    def only(self, rows: Indices) -> Obstacles:
        """The boxes of these rows, which ascend."""
        return Obstacles(
            self.centers[rows],
            self.rotations[rows],
            self.halves[rows],
            self.roundings[rows],
            self.items[rows],
            self.is_label[rows],
        )


@lru_cache(maxsize=4)
def _bodies(obstacles: Obstacles) -> Obstacles:
    if not obstacles.is_label.any():
        return obstacles
    return obstacles.only(np.flatnonzero(~obstacles.is_label))


def obstacles_of(placement: Placement) -> Obstacles:
    """The boxes of all items of a placement, and of their labels' letters.

    A box and letters are their box; a ball is exact; a cylinder is the octagon around it, a cone
    four such slices. A tray is its floor and its walls: what stands in it is not in the obstacle.
    Whoever asks for the obstacles of the same arrays again gets the same.
    """
    return _obstacles(
        _Bodies(
            placement.centers,
            placement.rotations,
            placement.sizes,
            placement.solids,
            placement.labels,
        )
    )


class _Bodies(NamedTuple):
    """What is in the way of a placement; only the very same arrays are equal."""

    centers: Floats
    rotations: Floats
    sizes: Floats
    solids: tuple[Solid, ...]
    labels: tuple[LabelPlace | None, ...]

    def __hash__(self) -> int:
        return hash(tuple(map(id, self)))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Bodies) and all(map(operator.is_, self, other))


@lru_cache(maxsize=4)
def _obstacles(bodies: _Bodies) -> Obstacles:
    kinds: dict[tuple[Solid, Size], int] = {}
    chosen: list[int] = []
    items: list[int] = []
    letters: list[bool] = []
    placed: list[tuple[tuple[float, ...], tuple[float, ...]]] = []
    for number, (solid, size, label) in enumerate(
        zip(bodies.solids, map(tuple, bodies.sizes.tolist()), bodies.labels, strict=True)
    ):
        if any(length > 0.0 for length in size):
            chosen.append(kinds.setdefault((solid, size), len(kinds)))
            placed.append(_HERE)
            items.append(number)
            letters.append(False)
        if label is not None:
            chosen.append(kinds.setdefault((label.text, label.size), len(kinds)))
            placed.append((label.position, label.rotation))
            items.append(number)
            letters.append(True)
    if not kinds:
        nothing, nobody = np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
        return Obstacles(
            nothing, np.zeros((0, 3, 3)), nothing, np.zeros(0), nobody, nobody.astype(np.bool_)
        )
    hulls = [hull(solid, size) for solid, size in kinds]
    starts = starts_of(np.array([len(one.centers) for one in hulls]))
    rows = rows_of(starts, np.array(chosen))
    centers, turns, halves, roundings = (
        np.concatenate(arrays)[rows] for arrays in zip(*hulls, strict=True)
    )
    counts = np.diff(starts)[chosen]
    owners = np.repeat(np.array(items), counts)
    for positions, rotations in (
        _repeated(placed, counts),
        (bodies.centers[owners], bodies.rotations[owners]),
    ):
        frames = matrices(rotations)
        centers = positions + np.einsum("kij,kj->ki", frames, centers)
        turns = frames @ turns
    is_label = np.repeat(np.array(letters), counts)
    return Obstacles(centers, np.ascontiguousarray(turns), halves, roundings, owners, is_label)


_HERE = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def _repeated(
    placed: list[tuple[tuple[float, ...], tuple[float, ...]]], counts: Indices
) -> tuple[Floats, Floats]:
    positions = np.array([position for position, _ in placed])
    rotations = np.array([rotation for _, rotation in placed])
    return np.repeat(positions, counts, axis=0), np.repeat(rotations, counts, axis=0)


def near_obstacles(
    control_points: Floats,
    owners: Indices,
    radii: Floats,
    obstacles: Obstacles,
    passable: Indices,
    clearance: float,
    active: NDArray[np.bool_] | None = None,
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
