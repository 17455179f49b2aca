"""The ends of hyperedges, at the attachment points of items that have been placed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.placement import Placement
from app.placement.points import points_of
from app.placement.turning import Vector, turned
from app.placement.untouched import Untouched
from app.program.model import Hyperedge, Program


def attached(program: Program, placed: Placement, rest: Untouched | None = None) -> Placement:
    """The items that are ``placed``, with the attachments of all hyperedges of the program.

    Those of hyperedges that nothing has touched are the ones of before, to the last bit.
    """
    counts = np.array([len(each.attachments) for each in program.hyperedges], dtype=np.int64)
    starts = starts_of(counts)
    positions, directions = np.empty((starts[-1], 3)), np.empty((starts[-1], 3))
    owners = np.empty(starts[-1], dtype=np.int64)
    new = np.arange(len(counts))
    if rest is not None:
        numbers, stood = rest.hyperedges(), rest.stood
        new = np.flatnonzero(numbers < 0)
        here = rows_of(starts, np.flatnonzero(numbers >= 0))
        there = rows_of(stood.attachment_starts, numbers[numbers >= 0])
        positions[here] = stood.attachment_positions[there]
        directions[here] = stood.attachment_directions[there]
        owners[here] = rest.items_now()[stood.attachment_items[there]]
    if len(new):
        rows = rows_of(starts, new)
        chosen = [program.hyperedges[number] for number in new]
        positions[rows], directions[rows], owners[rows] = _ends(program, chosen, placed)
    return replace(
        placed,
        attachment_positions=positions,
        attachment_directions=directions,
        attachment_starts=starts,
        attachment_items=owners,
    )


def _ends(
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
    return np.array(positions)[used], np.array(directions)[used], owners[used]
