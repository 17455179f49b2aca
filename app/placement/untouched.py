"""What an edit does not concern, taken over as it stood without being placed again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Indices
from app.placement.family import family
from app.placement.placement import Placement
from app.placement.standing import Standing
from app.program.model import Item, Program
from app.program.shapes import Csg

_OF_ITEMS = ("centers", "rotations", "sizes", "offsets", "turns")


@dataclass(frozen=True, slots=True, eq=False)
class Untouched:
    """Items that stand where they stood, whatever became of the others.

    ``numbers`` (n,) say which of the items ``before`` each one is; -1 for those to be placed.
    """

    program: Program
    before: Program
    stood: Placement
    numbers: Indices

    @property
    def others(self) -> Program:
        """A program of those items alone that are to be placed."""
        items = tuple(self.program.items[number] for number in np.flatnonzero(self.numbers < 0))
        layout = self.program.layout.model_copy(update={"constraints": ()})
        return self.program.model_copy(update={"items": items, "hyperedges": (), "layout": layout})

    def beside(self, placed: Placement) -> Placement:
        """All items, of which the others have been ``placed``; the attachments are those of these.

        Arrays are those of before where nothing differs.
        """
        stood, new = self.stood, self.numbers < 0
        parents = np.array(family(self.program).parents, dtype=np.int64)
        placed = replace(placed, parents=parents)
        if np.array_equal(self.numbers, np.arange(len(stood.centers))):
            arrays = {name: getattr(stood, name) for name in _OF_ITEMS}
            return replace(placed, solids=stood.solids, labels=stood.labels, **arrays)
        rows = np.where(new, len(stood.centers) + np.cumsum(new) - 1, self.numbers)
        arrays = {
            name: np.concatenate([getattr(stood, name), getattr(placed, name)])[rows]
            for name in _OF_ITEMS
        }
        solids, labels = stood.solids + placed.solids, stood.labels + placed.labels
        return replace(
            placed,
            solids=tuple(solids[row] for row in rows),
            labels=tuple(labels[row] for row in rows),
            **arrays,
        )


def untouched(program: Program, standing: Standing) -> Untouched | None:
    """The items that an edit does not concern, if it is plain that it concerns no more.

    So it is where whatever is new or has changed is no part of anything, has no parts, and says
    itself where it stands: nothing else makes room for it. Where it is less plain, ``None``.
    """
    before = standing.program
    if standing.whole is None or _rules(before) != _rules(program):
        return None
    known = {item.id: number for number, item in enumerate(before.items)}
    numbers = [_placed_as(item, known.get(item.id, -1), before.items) for item in program.items]
    changed = [item for item, number in zip(program.items, numbers, strict=True) if number < 0]
    if any(item.position is None or isinstance(item.shape, Csg) for item in changed):
        return None
    kept = set(numbers)
    gone = [item for number, item in enumerate(before.items) if number not in kept]
    if not (_are_alone(changed, program) and _are_alone(gone, before)):
        return None
    return Untouched(program, before, standing.whole, np.array(numbers, dtype=np.int64))


def _rules(program: Program) -> tuple[object, ...]:
    """What places depend on, beside the items."""
    return (program.notation, program.style.labels, program.layout)


def _placed_as(item: Item, number: int, before: Sequence[Item]) -> int:
    if number < 0:
        return -1
    other = before[number]
    if item is other or item == other or _without_looks(item) == _without_looks(other):
        return number
    return -1


def _without_looks(item: Item) -> Item:
    looks: dict[str, object] = {
        "material": None,
        "finish": None,
        "translucency": None,
        "color": None,
        "data": {},
    }
    return item.model_copy(update=looks)


def _are_alone(items: Sequence[Item], program: Program) -> bool:
    """Whether none of these items of a program is part of anything, or has parts."""
    parents = {item.parent for item in program.items} if items else set()
    return all(item.parent is None and item.id not in parents for item in items)
