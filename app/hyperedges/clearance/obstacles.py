"""Items as obstacles for hyperedges that do not attach to them."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.hulls import hull
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
    is_label: Flags

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
