"""What the author of a program can do about each conflict, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from app.arrays import Indices
from app.hyperedges.clearance.conflicts import Conflicts
from app.hyperedges.clearance.nearest_ends import nearest_ends
from app.placement.placement import Placement
from app.program.model import Program

ROOM = 2.0
"""Attachments this many times as far apart as tubes need can be kept clear (docs/clearance.md)."""

BESIDE = 4.0
"""A conflict is due to an attachment that is no farther off than this times what tubes need."""


def remedies(
    program: Program, placement: Placement, conflicts: Conflicts, clearance: float
) -> Iterator[str]:
    """For each conflict what makes room, named by what is nearest to it."""
    with_items = conflicts.with_items
    radii = placement.radii[conflicts.first]
    others = np.where(with_items, 0, conflicts.second)
    needs = radii + clearance + np.where(with_items, 0.0, placement.radii[others])
    ends, far = nearest_ends(placement, conflicts.first, conflicts.places)
    other_ends, other_far = nearest_ends(placement, others, conflicts.places)
    positions = placement.attachment_positions
    apart = np.linalg.norm(positions[ends] - positions[other_ends], axis=1)
    near = far <= BESIDE * needs
    crowded = near & (other_far <= BESIDE * needs) & (apart < ROOM * needs) & ~with_items
    names = _Names(program, placement.attachment_starts)
    for number in range(len(conflicts)):
        end = int(ends[number])
        if crowded[number]:
            yield _crowded(
                names, end, int(other_ends[number]), float(apart[number]), float(needs[number])
            )
        elif with_items[number]:
            item = program.items[int(conflicts.second[number])].id
            yield _beside_item(names, end, item, bool(near[number]))
        else:
            yield "Move the items between which both run farther apart, or ask for less clearance."


class _Names:
    """What the document calls attachments, by their numbers."""

    def __init__(self, program: Program, starts: Indices) -> None:
        self._program, self._starts = program, starts

    def of(self, attachment: int) -> tuple[str, str | None]:
        """The item that it attaches to, and the point, if the document names one."""
        hyperedge = int(np.searchsorted(self._starts, attachment, side="right")) - 1
        found = self._program.hyperedges[hyperedge].attachments[
            attachment - int(self._starts[hyperedge])
        ]
        return found.item, found.point


def _crowded(names: _Names, one: int, other: int, apart: float, need: float) -> str:
    (item, point), (other_item, other_point) = names.of(one), names.of(other)
    gap = f"{apart:.3g} apart, where {ROOM * need:.3g} is enough"
    if item != other_item:
        return f"Move {item!r} and {other_item!r} apart: the ends there are {gap}."
    if point is None and other_point is None:
        return f"Make {item!r} larger, or the tubes thinner: the ends there are {gap}."
    if point == other_point:
        return (
            f"Leave out the point {point!r} of {item!r} so that ends are spread over the item, or "
            f"make the item larger: the ends there are {gap}."
        )
    points = " and ".join(repr(name) for name in (point, other_point) if name is not None)
    return f"Move the points of {item!r} apart ({points}): the ends there are {gap}."


def _beside_item(names: _Names, end: int, item: str, is_near: bool) -> str:
    own, point = names.of(end)
    if own == item:
        where = "the attachment" if point is None else f"the point {point!r}"
        return f"Let {where} on {item!r} face outwards, or leave its direction out."
    if is_near:
        return f"Move {item!r} away from {own!r}, or attach on another side of {own!r}."
    return f"Move {item!r} out of the way, or the items between which it stands farther apart."
