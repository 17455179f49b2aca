"""The ends of hyperedges, at the attachment points of items that have been placed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.all_round import all_round
from app.placement.placement import Placement
from app.placement.points import points_of
from app.placement.previous_attachments import PreviousAttachments, previous_attachments
from app.placement.separating import separated
from app.placement.spreading import is_spread, spread
from app.placement.standing import Standing
from app.placement.turning import Vector, turned
from app.program.model import Hyperedge, Program


def attached(program: Program, placed: Placement, standing: Standing | None = None) -> Placement:
    """The items that are ``placed``, with the attachments of all hyperedges of the program.

    What would end at the same place gets places side by side, and what is almost far enough apart
    is moved by what is missing. After an edit, ends that are attached as they were stay where they
    were: to the last bit where their item has not moved, and else at the same place of the item.
    ``placed`` has the radii of all hyperedges.
    """
    counts = np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
    starts = starts_of(counts)
    before = None if standing is None else previous_attachments(program, placed, standing)
    stays = np.zeros(len(counts), dtype=np.bool_) if before is None else before.stays
    positions, directions = np.empty((starts[-1], 3)), np.empty((starts[-1], 3))
    owners = np.empty(starts[-1], dtype=np.int64)
    new = np.flatnonzero(~stays)
    if before is not None:
        rows = rows_of(starts, np.flatnonzero(stays))
        positions[rows], directions[rows] = before.at(rows)
        owners[rows] = before.items[rows]
    if len(new):
        rows = rows_of(starts, new)
        chosen = [program.hyperedges[number] for number in new]
        positions[rows], directions[rows], owners[rows] = ends_at_points(program, chosen, placed)
    whole = replace(
        placed,
        attachment_positions=positions,
        attachment_directions=directions,
        attachment_starts=starts,
        attachment_items=owners,
    )
    held = np.repeat(stays, counts)
    if before is not None and is_spread(program):
        whole, held = _followed(whole, before, held)
    if not placed.stands and is_spread(program):
        whole = all_round(program, whole, held)
        unnamed = [end.point is None for each in program.hyperedges for end in each.attachments]
        held = held | np.array(unnamed, dtype=np.bool_)
    return apart(program, whole, held)


def apart(program: Program, placement: Placement, held: Flags) -> Placement:
    """The placement with ends at the same place side by side, but for those ``held`` (a,)."""
    if not is_spread(program):
        return placement
    return separated(spread(program, placement, held), program.layout.clearance or 0.0, held)


def _followed(
    placement: Placement, before: PreviousAttachments, held: Flags
) -> tuple[Placement, Flags]:
    """Ends that had a place of their own have it on their items, wherever these are now."""
    positions, directions = (
        placement.attachment_positions.copy(),
        placement.attachment_directions.copy(),
    )
    rows = before.displaced(placement, np.flatnonzero(~held))
    positions[rows], directions[rows] = before.on_items(placement, rows)
    held = held.copy()
    held[before.known] = True
    return (
        replace(placement, attachment_positions=positions, attachment_directions=directions),
        held,
    )


def ends_at_points(
    program: Program, hyperedges: Sequence[Hyperedge], placed: Placement
) -> tuple[Floats, Floats, Indices]:
    """Positions (a, 3), unit directions (a, 3) and items (a,) of the ends of hyperedges.

    Many may end at one attachment point: its place is found once.
    """
    ends = [(end.item, end.point) for hyperedge in hyperedges for end in hyperedge.attachments]
    known: dict[tuple[str, str | None], int] = {}
    used = np.array([known.setdefault(end, len(known)) for end in ends], dtype=np.int64)
    numbers = {item.id: number for number, item in enumerate(program.items)}
    owners = np.array([numbers[name] for name, _ in known], dtype=np.int64)
    centers, rotations, sizes = (
        array[owners].tolist() for array in (placed.centers, placed.rotations, placed.sizes)
    )
    points: dict[int, dict[str | None, tuple[Vector, Vector]]] = {}
    positions: list[Vector] = []
    directions: list[Vector] = []
    for (_, point), number, center, rotation, size in zip(
        known, owners.tolist(), centers, rotations, sizes, strict=True
    ):
        if number not in points:
            points[number] = points_of(program.items[number], placed.solids[number], size)
        position, direction = points[number][point]
        x, y, z = turned(rotation, position)
        a, b, c = center
        positions.append((a + x, b + y, c + z))
        directions.append(turned(rotation, direction))
    return (
        np.array(positions).reshape(-1, 3)[used],
        np.array(directions).reshape(-1, 3)[used],
        owners[used],
    )
