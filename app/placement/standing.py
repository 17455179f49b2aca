"""Where items stood before an edit, so that it moves none that it does not concern."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.arrays import Floats
from app.placement.family import Family
from app.placement.placement import Placement
from app.placement.sized import Sized, Stood
from app.program.model import Helix, Item, LineUp, Program
from app.solids.solid import Box, Tray


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """The n items of an earlier state of a program, and where they stood.

    ``centers`` (n, 3) and ``rotations`` (n, 4) are in the world, ``offsets`` (n, 3) and ``turns``
    (n, 4) within the parent, ``sizes`` (n, 3) in the items' own axes; as in `Placement`.
    """

    program: Program
    centers: Floats
    rotations: Floats
    sizes: Floats
    offsets: Floats
    turns: Floats

    @classmethod
    def of(cls, program: Program, placement: Placement) -> Standing:
        """What ``placement``, made by `app.placement.place.place`, says of ``program``."""
        return cls(
            program,
            placement.centers,
            placement.rotations,
            placement.sizes,
            placement.offsets,
            placement.turns,
        )


def recall(sized: Sequence[Sized], program: Program, family: Family, standing: Standing) -> None:
    """Tell each of ``sized`` where it stood, and give it the size that it had.

    An item that was elsewhere, within another parent or in another notation, did not stand
    anywhere.
    """
    before = standing.program
    if (before.notation, before.style.labels) != (program.notation, program.style.labels):
        return
    numbers = {item.id: number for number, item in enumerate(before.items)}
    parents = {item.parent for item in before.items}
    lines, lines_before = _lines(program), _lines(before)
    offsets, centers = standing.offsets.tolist(), standing.centers.tolist()
    turns, rotations = standing.turns.tolist(), standing.rotations.tolist()
    sizes = standing.sizes.tolist()
    for number, each in enumerate(sized):
        item = each.item
        old = numbers.get(item.id)
        if old is None or before.items[old].parent != item.parent:
            continue
        if lines.get(item.id) != lines_before.get(item.id):
            continue
        contained = (item.id in parents, bool(family.children[number]))
        alike = contained[0] == contained[1] and _looks(item) == _looks(before.items[old])
        each.stood = Stood(
            offset=tuple(offsets[old]),
            center=tuple(centers[old]),
            rotation=tuple(rotations[old]),
            alike=alike,
        )
        if not alike:
            continue
        each.turn, each.size = tuple(turns[old]), tuple(sizes[old])
        if isinstance(each.solid, Box | Tray):
            each.solid = replace(each.solid, size=each.size)


def _looks(item: Item) -> tuple[object, ...]:
    """What an item's own size depends on, and how it is turned."""
    return (item.kind, item.label, item.shape, item.rotation)


def _lines(program: Program) -> dict[str, LineUp | Helix]:
    """What each of those that line up stands in."""
    return {name: line for line in program.layout.constraints for name in line.items}
