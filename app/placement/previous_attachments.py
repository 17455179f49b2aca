"""Where hyperedges were attached before an edit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.placement.turning import matrices
from app.program.former import former_numbers
from app.program.model import Program

AT_THE_POINT = 1e-9
"""Document units: an end so near to its attachment point has no place of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class PreviousAttachments:
    """The a ends of h hyperedges as they were in an earlier placement, ``old``.

    ``known`` (a,): which ends were there before, on an item of the same size and shape with the
    same points. Of these ``rows`` (a,) in the old placement, and their ``items`` (a,) as they are
    numbered now. ``stays`` (h,): hyperedges all of whose ends are on items that have not moved by a
    bit.
    """

    old: Placement
    known: Flags
    stays: Flags
    items: Indices
    rows: Indices

    def at(self, ends: Indices) -> tuple[Floats, Floats]:
        """Positions and directions (e, 3) in the world where known ``ends`` (e,) were."""
        rows = self.rows[ends]
        return self.old.attachment_positions[rows], self.old.attachment_directions[rows]

    def displaced(self, placement: Placement, ends: Indices) -> Indices:
        """Those of the ``ends`` (e,) that are known and were not where the ``placement`` has them.

        Both are compared in the axes of the items.
        """
        ends = ends[self.known[ends]]
        items = placement.attachment_items[ends]
        now = _in_axes(placement.attachment_positions[ends], placement, items)
        away = np.abs(now - self._local(ends)).max(axis=1, initial=0.0)
        return np.asarray(ends[away > AT_THE_POINT])

    def on_items(self, placement: Placement, ends: Indices) -> tuple[Floats, Floats]:
        """Positions and directions (e, 3) of known ``ends`` on their items as these are now."""
        items = placement.attachment_items[ends]
        frames = matrices(placement.rotations[items])
        rows = self.rows[ends]
        former = matrices(self.old.rotations[self.old.attachment_items[rows]])
        outward = np.einsum("aij,ai->aj", former, self.old.attachment_directions[rows])
        places = placement.centers[items] + np.einsum("aij,aj->ai", frames, self._local(ends))
        return places, np.einsum("aij,aj->ai", frames, outward)

    def _local(self, ends: Indices) -> Floats:
        """Where known ends (e,) were in the axes of their items, (e, 3)."""
        rows = self.rows[ends]
        return _in_axes(
            self.old.attachment_positions[rows], self.old, self.old.attachment_items[rows]
        )


def previous_attachments(
    program: Program, placed: Placement, standing: Standing
) -> PreviousAttachments | None:
    """What is known of the ends of a program's hyperedges; ``None`` where nothing is.

    ``placed`` are its items as they are now.
    """
    old = standing.whole
    if old is None or standing.program.layout.dimensions != program.layout.dimensions:
        return None
    counts = np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
    starts, numbers = starts_of(counts), _same_ends(program, standing.program)
    if not (numbers >= 0).any():
        return None
    now = _items_now(program, placed, standing, old)
    there = rows_of(old.attachment_starts, numbers[numbers >= 0])
    here = rows_of(starts, np.flatnonzero(numbers >= 0))
    alike = now[old.attachment_items[there]] >= 0
    here, there = here[alike], there[alike]
    former = old.attachment_items[there]
    items, rows = np.full(starts[-1], -1), np.full(starts[-1], -1)
    items[here], rows[here] = now[former], there
    unmoved = np.zeros(starts[-1], dtype=np.bool_)
    unmoved[here] = (_bits(placed.centers)[items[here]] == _bits(old.centers)[former]).all(axis=1)
    unmoved[here] &= (_bits(placed.rotations)[items[here]] == _bits(old.rotations)[former]).all(
        axis=1
    )
    stays = np.logical_and.reduceat(unmoved, starts[:-1])
    return PreviousAttachments(old, rows >= 0, stays, items, rows)


def _same_ends(program: Program, before: Program) -> Indices:
    """Which hyperedge of before each one is (h,) that has the same attachments; -1 for others."""
    numbers = former_numbers(program, before)
    for number, former in enumerate(numbers.tolist()):
        if former < 0:
            continue
        ends = program.hyperedges[number].attachments
        others = before.hyperedges[former].attachments
        if not (ends is others or ends == others):
            numbers[number] = -1
    return numbers


def _in_axes(places: Floats, placement: Placement, items: Indices) -> Floats:
    """Places (n, 3) in the axes of ``items`` (n,), about their centres."""
    frames = matrices(placement.rotations[items])
    return np.asarray(np.einsum("aij,ai->aj", frames, places - placement.centers[items]))


def _items_now(program: Program, placed: Placement, standing: Standing, old: Placement) -> Indices:
    """Numbers of the items of before as they are now, where size, shape and points are the same."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    now = np.array([numbers.get(item.id, -1) for item in standing.program.items], dtype=np.int64)
    same_size = (_bits(placed.sizes)[now] == _bits(old.sizes)).all(axis=1)
    now[~same_size] = -1
    for former in np.flatnonzero(now >= 0).tolist():
        number = int(now[former])
        item, before = program.items[number], standing.program.items[former]
        solid, old_solid = placed.solids[number], old.solids[former]
        if not (item is before or item.attachment_points == before.attachment_points) or not (
            solid is old_solid or solid == old_solid
        ):
            now[former] = -1
    return now


def _bits(values: Floats) -> Indices:
    return np.ascontiguousarray(values).view(np.int64)
