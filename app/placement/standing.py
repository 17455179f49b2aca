"""Where items stood before an edit, so that it moves none that it does not concern."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from app.arrays import Floats
from app.placement.family import Family
from app.placement.fitting import LABEL_MARGIN
from app.placement.modes import Mode
from app.placement.placement import Placement
from app.placement.sized import Sized, Stood
from app.program.model import Helix, Item, LineUp, Program
from app.solids.solid import Box, Tray

ALIKE = 1.7
"""Blocks of one kind in one parent get one width where the widest is at most so many times as wide
as the narrowest; and a block with a shorter label keeps its width, if that is not wider."""


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """The n items of an earlier state of a program, and where they stood.

    ``centers`` (n, 3) and ``rotations`` (n, 4) are in the world, ``offsets`` (n, 3) and ``turns``
    (n, 4) within the parent, ``sizes`` (n, 3) in the items' own axes; as in `Placement`. ``whole``
    is all that was placed, where it is at hand, and not flattened. ``mode`` is that of the
    placement.
    """

    program: Program
    centers: Floats
    rotations: Floats
    sizes: Floats
    offsets: Floats
    turns: Floats
    mode: Mode = field(default="rows", kw_only=True)
    whole: Placement | None = field(default=None, kw_only=True)

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
            mode=placement.mode,
            whole=None if program.layout.dimensions == 2 else placement,
        )


def recall(sized: Sequence[Sized], program: Program, family: Family, standing: Standing) -> None:
    """Tell each of ``sized`` where it stood, and give it the size that it had.

    An item that was elsewhere, within another parent or in another notation, did not stand
    anywhere; nor did one that lines up with others than before, or in another order.
    """
    before = standing.program
    if (before.notation, before.style.labels) != (program.notation, program.style.labels):
        return
    numbers = {item.id: number for number, item in enumerate(before.items)}
    parents = {item.parent for item in before.items}
    lines, lines_before = _lines(program), _lines(before)
    wanted = [numbers[each.item.id] for each in sized if each.item.id in numbers]
    offsets, centers, turns, rotations, sizes = (
        dict(zip(wanted, array[wanted].tolist(), strict=True))
        for array in (
            standing.offsets,
            standing.centers,
            standing.turns,
            standing.rotations,
            standing.sizes,
        )
    )
    for number in family.order:
        each = sized[number]
        item = each.item
        old = numbers.get(item.id)
        if old is None or before.items[old].parent != item.parent:
            continue
        if not _is_in_line(lines.get(item.id), lines_before.get(item.id)):
            continue
        contains = bool(family.children[number])
        same = contains == (item.id in parents)
        alike = same and _is_alike(each, before.items[old], sizes[old], contains=contains)
        each.stood = Stood(
            offset=tuple(offsets[old]),
            center=tuple(centers[old]),
            rotation=tuple(rotations[old]),
            size=tuple(sizes[old]),
            alike=alike,
            labelled=item.label == before.items[old].label,
        )
        if not alike:
            continue
        each.turn = tuple(turns[old])
        each.resize(tuple(sizes[old]))
    _wind_whole(sized, program, family)


def _is_alike(each: Sized, before: Item, size: Sequence[float], *, contains: bool) -> bool:
    """Whether an item looks as it did, or near enough to keep its size.

    A tray around contents takes another label into the room that it has, or grows; a block does
    where that is neither too narrow, be it with narrower margins, nor much too wide.
    """
    item = each.item
    if _looks(item) != _looks(before):
        return False
    if item.label == before.label:
        return True
    if contains:
        return isinstance(each.solid, Tray)
    if not isinstance(each.solid, Box):
        return False
    width, depth, height = each.size
    return width - LABEL_MARGIN <= size[0] <= ALIKE * width and (depth, height) == (
        size[1],
        size[2],
    )


def _looks(item: Item) -> tuple[object, ...]:
    """What an item's own size depends on, beside its label, and how it is turned."""
    return (item.kind, item.shape, item.rotation)


def _lines(program: Program) -> dict[str, LineUp | Helix]:
    """What each of those that line up stands in."""
    return {name: line for line in program.layout.constraints for name in line.items}


def _is_in_line(now: LineUp | Helix | None, before: LineUp | Helix | None) -> bool:
    """Whether what stood in line ``before`` stands right in line ``now``, or needs no line."""
    if now is None:
        return not isinstance(before, Helix)
    if before is None or now.model_copy(update={"items": before.items}) != before:
        return False
    rest = iter(before.items)
    return all(name in rest for name in now.items)


def _wind_whole(sized: Sequence[Sized], program: Program, family: Family) -> None:
    """Where one of a helix has changed, or what it stands on, all of the helix is wound anew."""
    helices = [line for line in program.layout.constraints if isinstance(line, Helix)]
    if not helices:
        return
    numbers = {item.id: number for number, item in enumerate(program.items)}
    for helix in helices:
        members = [numbers[name] for name in helix.items]
        parent = family.parents[members[0]]
        if not all(sized[each].is_alike for each in members + [parent] * (parent >= 0)):
            for each in members:
                sized[each].forget()
