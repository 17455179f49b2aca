"""What lines up, as blocks that are placed as one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from app.placement.family import Family
from app.placement.helix import Bulk, leaning, wind
from app.placement.rows import arrange
from app.placement.sized import Place, Sized
from app.placement.still import Block, Groups
from app.placement.turning import then
from app.program.model import Helix, LineUp, Program


def line_ups_of(
    program: Program, family: Family
) -> dict[int, list[tuple[LineUp | Helix, list[int]]]]:
    """What lines up in each item (-1: among the roots), with the numbers of its members."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    found: dict[int, list[tuple[LineUp | Helix, list[int]]]] = defaultdict(list)
    for line_up in program.layout.constraints:
        members = [numbers[name] for name in line_up.items]
        found[family.parents[members[0]]].append((line_up, members))
    return found


def blocks_of(
    sized: Sequence[Sized], free: Sequence[int], line_ups: Groups, gap: float
) -> list[Block]:
    """What stands together, in order: each of ``free`` alone, or the line that it is in."""
    taken = {child: sized[child].footprint for child in free}
    line_of = {child: (line_up, members) for line_up, members in line_ups for child in members}
    blocks: list[Block] = []
    for child in free:
        if child not in line_of:
            blocks.append(Block({child: (0.0, 0.0)}, taken[child].size))
            continue
        line_up, members = line_of[child]
        if child != members[0]:
            continue
        if isinstance(line_up, Helix):
            around, centers = _wind([sized[member] for member in members], line_up, gap)
            size = (around, around)
        else:
            inner = arrange([taken[member].size for member in members], gap, line_up.type)
            size, centers = (inner.width, inner.depth), list(inner.centers)
        blocks.append(Block(dict(zip(members, centers, strict=True)), size))
    return blocks


def _wind(members: Sequence[Sized], helix: Helix, gap: float) -> tuple[float, list[Place]]:
    """Turn and lift ``members``; the width of all, and where the middles of footprints are."""
    lean = leaning(helix)
    bulks = [Bulk.of(*member.whole, then(lean, member.turn)) for member in members]
    wound = wind(helix, bulks, gap)
    places: list[Place] = []
    for member, (x, y, z), turn in zip(members, wound.centers, wound.turns, strict=True):
        aside = member.footprint.center
        places.append((x - aside[0], y - aside[1]))
        member.turn, member.lift = then(turn, member.turn), z
    return 2 * wound.reach, places
