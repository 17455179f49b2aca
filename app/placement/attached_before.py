"""Where hyperedges ended before an edit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.placement.turning import matrices
from app.program.model import Program

AT_THE_POINT = 1e-9
"""Document units: an end so near to its attachment point has no place of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class Before:
    """The a ends of h hyperedges as they were in an earlier placement.

    ``known`` (a,): which ends were there before, on an item of the same size and shape with the
    same points. Of these ``positions`` and ``directions`` (a, 3) in the world, their ``items``
    (a,) as they are numbered now, and the same places in the items' axes, ``local`` (a, 3) and
    ``outward`` (a, 3). ``stays`` (h,): hyperedges all of whose ends are on items that have not
    moved by a bit.
    """

    known: Flags
    stays: Flags
    items: Indices
    positions: Floats
    directions: Floats
    local: Floats
    outward: Floats

    def displaced(self, placement: Placement) -> Flags:
        """Which known ends (a,) were not at the point where the ``placement`` has them."""
        frames = matrices(placement.rotations)[placement.attachment_items]
        away = placement.attachment_positions - placement.centers[placement.attachment_items]
        now = np.einsum("aij,ai->aj", frames, away)
        return np.asarray(self.known & (np.abs(now - self.local).max(axis=1) > AT_THE_POINT))

    def on_items(self, placement: Placement, rows: Indices) -> tuple[Floats, Floats]:
        """Positions and directions (r, 3) of known ends on their items as these are now."""
        items = placement.attachment_items[rows]
        frames = matrices(placement.rotations)[items]
        places = placement.centers[items] + np.einsum("aij,aj->ai", frames, self.local[rows])
        return places, np.einsum("aij,aj->ai", frames, self.outward[rows])


def attached_before(program: Program, placed: Placement, standing: Standing) -> Before | None:
    """What is known of the ends of a program's hyperedges; ``None`` where nothing is.

    ``placed`` are its items as they are now.
    """
    old = standing.whole
    if old is None or standing.program.layout.dimensions != program.layout.dimensions:
        return None
    counts = np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
    starts, numbers = starts_of(counts), _numbers(program, standing.program)
    if not (numbers >= 0).any():
        return None
    now = _items_now(program, placed, standing, old)
    there = rows_of(old.attachment_starts, numbers[numbers >= 0])
    here = rows_of(starts, np.flatnonzero(numbers >= 0))
    former = old.attachment_items[there]
    alike = now[former] >= 0
    here, there, former = here[alike], there[alike], former[alike]
    items = now[former]
    known = np.zeros(starts[-1], dtype=np.bool_)
    known[here] = True
    unmoved = known.copy()
    unmoved[here] = (_bits(placed.centers)[items] == _bits(old.centers)[former]).all(axis=1) & (
        _bits(placed.rotations)[items] == _bits(old.rotations)[former]
    ).all(axis=1)
    stays = np.logical_and.reduceat(unmoved, starts[:-1])
    found = Before(
        known,
        stays,
        np.full(starts[-1], -1),
        *(np.zeros((starts[-1], 3)) for _ in range(4)),
    )
    frames = matrices(old.rotations)[former]
    found.items[here] = items
    found.positions[here] = old.attachment_positions[there]
    found.directions[here] = old.attachment_directions[there]
    away = old.attachment_positions[there] - old.centers[former]
    found.local[here] = np.einsum("aij,ai->aj", frames, away)
    found.outward[here] = np.einsum("aij,ai->aj", frames, old.attachment_directions[there])
    return found


def _numbers(program: Program, before: Program) -> Indices:
    """Which hyperedge of before each one is (h,) that has the same attachments; -1 for others."""
    known = {hyperedge.id: number for number, hyperedge in enumerate(before.hyperedges)}
    numbers = np.full(len(program.hyperedges), -1)
    for number, hyperedge in enumerate(program.hyperedges):
        former = known.get(hyperedge.id, -1)
        if former < 0:
            continue
        ends, others = hyperedge.attachments, before.hyperedges[former].attachments
        if ends is others or ends == others:
            numbers[number] = former
    return numbers


def _items_now(program: Program, placed: Placement, standing: Standing, old: Placement) -> Indices:
    """Numbers of the items of before as they are now, where size, shape and points are the same."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    now = np.full(len(old.centers), -1)
    sizes, old_sizes = _bits(placed.sizes), _bits(old.sizes)
    for former, item in enumerate(standing.program.items):
        number = numbers.get(item.id, -1)
        if number < 0:
            continue
        same, solid = program.items[number], placed.solids[number]
        if (
            (same is item or same.attachment_points == item.attachment_points)
            and (solid is old.solids[former] or solid == old.solids[former])
            and np.array_equal(sizes[number], old_sizes[former])
        ):
            now[former] = number
    return now


def _bits(values: Floats) -> Indices:
    return np.ascontiguousarray(values).view(np.int64)
