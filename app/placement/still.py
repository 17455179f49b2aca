"""Contents after an edit: what stood stays, what is new stands beside it, what holds it grows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats
from app.placement.beside import beside, fits, overlaps
from app.placement.making_way import made_way
from app.placement.rooms import edge, edge_of_fixed
from app.placement.rows import Arrangement
from app.placement.sized import Place, Sized
from app.placement.turning import moved
from app.program.model import Helix, LineUp

Groups = Sequence[tuple[LineUp | Helix, list[int]]]
"""What stands together, with its members in order."""


@dataclass(frozen=True, slots=True)
class Block:
    """New siblings that stand together: where each is within the block, and its size."""

    members: Mapping[int, Place]
    size: Place


@dataclass(frozen=True, slots=True)
class Ground:
    """What siblings stand on: the room (4,) that there is, and how they stand beside each other."""

    room: Floats
    gap: float
    arrangement: Arrangement
    line_ups: Groups


def stays(sized: Sequence[Sized], number: int, children: Sequence[int]) -> bool:
    """Whether some of the ``children`` of an item (-1: the roots) stand where they stood.

    The others stand beside them then, and the item is as large as it was at least.
    """
    if any(sized[child].is_kept for child in children):
        return True
    if number < 0 or not sized[number].is_alike:
        return False
    return any(not sized[child].is_free for child in children)


def hold(
    sized: Sequence[Sized], children: Sequence[int], ground: Ground
) -> tuple[dict[int, Floats], dict[int, Place]]:
    """The rectangles of those that stay, by number: what has a position, and what stood.

    What takes more room than it did grows to where room is. In a row or a column its neighbours
    make way for it; elsewhere, what finds no room stays no longer: the second are the places near
    which it wants to be.
    """
    _leave_broken_lines(sized, ground.line_ups)
    standing: dict[int, Floats] = {}
    changed: list[int] = []
    for child in children:
        each = sized[child]
        if not each.is_free:
            standing[child] = edge_of_fixed(each)
        elif each.stood is None:
            continue
        elif each.is_as_before:
            standing[child] = edge(each, *each.stood.offset[:2])
        else:
            changed.append(child)
    near: dict[int, Place] = {}
    for child in changed:
        if not _settle(sized, child, standing, ground):
            line = next((line for _, line in ground.line_ups if child in line), [child])
            for member in line:
                stood = sized[member].stood
                if stood is not None:
                    near[member] = stood.offset[:2]
                standing.pop(member, None)
                sized[member].forget()
    return standing, near


def stand(
    standing: Mapping[int, Floats],
    near: Mapping[int, Place],
    blocks: Sequence[Block],
    ground: Ground,
) -> tuple[dict[int, Place], Floats]:
    """Middles of the footprints of new ones, by number, and the edges (4,) around all.

    Those that stood elsewhere stand again ``near`` there.
    """
    taken = list(standing.values())
    places: dict[int, Place] = {}
    for block in blocks:
        close = near.get(next(iter(block.members)))
        x, y = _block_place(taken, block, ground, close)
        width, depth = block.size
        taken.append(np.array([x - width / 2, y - depth / 2, x + width / 2, y + depth / 2]))
        places.update((child, (x + a, y + b)) for child, (a, b) in block.members.items())
    all_of_them = np.array(taken)
    return places, np.concatenate([all_of_them[:, :2].min(axis=0), all_of_them[:, 2:].max(axis=0)])


def _block_place(
    taken: Sequence[Floats], block: Block, ground: Ground, near: Place | None
) -> Place:
    """Where a block finds room; where nothing stands any more, around where it stood."""
    if not taken:
        return near or (0.0, 0.0)
    return beside(np.array(taken), block.size, ground.gap, ground.arrangement, ground.room, near)


def _leave_broken_lines(sized: Sequence[Sized], line_ups: Groups) -> None:
    """Where one of a line stands no longer, or has grown in a helix, none of it stands."""
    for line_up, members in line_ups:
        broken = any(sized[member].stood is None for member in members)
        if isinstance(line_up, Helix):
            broken |= not all(sized[member].is_as_before for member in members)
        if broken:
            for member in members:
                sized[member].forget()


def _settle(
    sized: Sequence[Sized], child: int, standing: dict[int, Floats], ground: Ground
) -> bool:
    """Let a changed item stay where it stood, or nearly so, if there is room or can be made."""
    each = sized[child]
    stood = each.stood
    if stood is None:
        return False
    others = np.array(list(standing.values())).reshape(-1, 4)
    choices = [
        ((x, y), edge(each, stood.offset[0] + x, stood.offset[1] + y)) for x, y in _leanings(each)
    ]
    # As far from others as they are from each other, then nearer; within its parent, then not.
    for gap, room in (
        (ground.gap, True), (ground.gap / 3, True), (ground.gap, False), (ground.gap / 3, False),
        (0.0, True), (0.0, False),
    ):  # fmt: skip
        for (x, y), rectangle in choices:
            if overlaps(rectangle, others, gap) or (room and not fits(rectangle, ground.room)):
                continue
            each.stood = replace(stood, offset=moved(stood.offset, (x, y, 0.0)))
            standing[child] = rectangle
            return True
    line, arrangement = _line_of(sized, child, standing, ground)
    if arrangement == "rows":
        return False
    way = made_way(
        {member: standing[member] for member in line}, child, choices, ground.gap, arrangement
    )
    if _hits(way.rectangles, standing):
        return False
    for member, rectangle in way.rectangles.items():
        before = standing.get(member)
        by = way.lean if before is None else tuple((rectangle - before)[:2].tolist())
        kept = sized[member].stood
        if kept is not None and any(by):
            # What makes way is placed anew in the world; what changed is so anyway.
            sized[member].stood = replace(
                kept, offset=moved(kept.offset, (by[0], by[1], 0.0)), center=None
            )
        standing[member] = rectangle
    return True


def _leanings(each: Sized) -> Iterator[Place]:
    """Ways to grow: to both sides, or to one. What holds others has grown to a side already."""
    yield 0.0, 0.0
    if each.contains or each.stood is None:
        return
    wide = max(0.0, (each.size[0] - each.stood.size[0]) / 2)
    deep = max(0.0, (each.size[1] - each.stood.size[1]) / 2)
    for y in (0.0, deep, -deep):
        for x in (wide, -wide, 0.0):
            if x or y:
                yield x, y


def _line_of(
    sized: Sequence[Sized], child: int, standing: Mapping[int, Floats], ground: Ground
) -> tuple[list[int], Arrangement]:
    """The free ones that stand in one row or column with an item, and which of these it is."""
    for line_up, members in ground.line_ups:
        if child in members:
            arrangement: Arrangement = "rows" if isinstance(line_up, Helix) else line_up.type
            return [member for member in members if member in standing], arrangement
    return [member for member in standing if sized[member].is_free], ground.arrangement


def _hits(moving: Mapping[int, Floats], standing: Mapping[int, Floats]) -> bool:
    """Whether any of those that move would come over one that stands."""
    others = [rectangle for child, rectangle in standing.items() if child not in moving]
    if not others:
        return False
    edges = np.array(others)
    return any(overlaps(rectangle, edges) for rectangle in moving.values())
