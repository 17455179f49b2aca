"""Sizes from the inside out: every item around what it contains."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

import numpy as np

from app.notations.notation import ItemStyle
from app.placement.blocks import blocks_of, line_ups_of
from app.placement.by_stress import by_stress
from app.placement.contents_by_stress import Stress, Within, beside_joined, contain_by_stress
from app.placement.enclosing import Contents, enclose, grow
from app.placement.family import Family
from app.placement.rooms import Rooms, edge_of_fixed
from app.placement.rows import Arrangement, arrange
from app.placement.sized import Place, Sized, alone, own_turn
from app.placement.standing import ALIKE, Standing, recall
from app.placement.still import Ground, Groups, hold, stand, stays
from app.placement.turning import UNTURNED
from app.program.model import Helix, Program
from app.solids.solid import Box, Tray

ROOT_GAP = 0.6

DEEPER = 1.4
"""How far a tray is stretched at most, to be as deep as its neighbours."""


def measure(
    program: Program,
    family: Family,
    styles: Sequence[ItemStyle],
    standing: Standing | None = None,
    stress: Stress | None = None,
) -> tuple[list[Sized], dict[int, Place]]:
    """All items with their solids, and the places of free roots in the world.

    What is ``standing`` stays where it is, as far as there is room for what has changed. Where
    ``stress`` is given, places are found by that: on the ground those of the contents of trays too,
    elsewhere those of the roots alone.

    Raises `InconsistentDocument` and `DocumentTooLarge` for trees of solids that come to no body.
    """
    line_ups = line_ups_of(program, family)
    sized = alone(program, family, styles)
    if standing is not None:
        recall(sized, program, family, standing)
    rooms = Rooms(sized, family, [*(style.gap for style in styles), ROOT_GAP])
    for number in reversed(family.order):
        children = family.children[number]
        if children:
            style = styles[number]
            lines = line_ups.get(number, [])
            how = (lines, style.gap, style.arrangement)
            by = None if stress is None or style.arrangement != "rows" else stress.within(number)
            if stays(sized, number, children):
                contents = _contain_more(sized, number, children, *how, rooms, by)
                grow(sized, number, children, contents)
            elif sized[number].is_alike:
                # None of its contents stands, but it does, and is as large as it was at least.
                grow(sized, number, children, contain(sized, children, *how, by))
            else:
                enclose(sized[number], contain(sized, children, *how, by))
    lines = line_ups.get(-1, [])
    if stress is not None and stress.mode != "ground":
        return sized, _off_ground(sized, family.roots, lines, stress)
    by = None if stress is None else stress.within(-1)
    if stays(sized, -1, family.roots):
        roots = _contain_more(sized, -1, family.roots, lines, ROOT_GAP, "rows", rooms, by)
    else:
        roots = contain(sized, family.roots, lines, ROOT_GAP, "rows", by)
    return sized, roots.places


def contain(
    sized: Sequence[Sized],
    children: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
    stress: Within | None = None,
) -> Contents:
    """Arrange the free ones of ``children``; those with positions stay."""
    free = [child for child in children if sized[child].is_free]
    _make_alike([sized[child] for child in free])
    if stress is not None and free:
        return contain_by_stress(sized, children, blocks_of(sized, free, line_ups, gap), stress)
    places, width, depth = _arrange_free(sized, free, line_ups, gap, arrangement)
    fixed = [sized[child] for child in children if not sized[child].is_free]
    around = np.array([-width / 2, -depth / 2, width / 2, depth / 2])
    if not fixed:
        return Contents(places, around, fixed=False)
    edges = np.array([edge_of_fixed(each) for each in fixed])
    left, near = edges[:, :2].min(axis=0)
    right, far = edges[:, 2:].max(axis=0)
    if free:
        # The free ones stand before the box of those with positions.
        x, y = float(left + right) / 2, float(near) - gap - depth / 2
        places = {child: (x + place[0], y + place[1]) for child, place in places.items()}
        left, near, right = min(left, x - width / 2), y - depth / 2, max(right, x + width / 2)
    return Contents(places, np.array([left, near, right, far]), fixed=True)


def _arrange_free(
    sized: Sequence[Sized],
    free: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
) -> tuple[dict[int, Place], float, float]:
    """Places about the centre, width and depth; what lines up is arranged first, then as one."""
    taken = {child: sized[child].footprint for child in free}
    blocks = blocks_of(sized, free, line_ups, gap)
    outer = arrange([block.size for block in blocks], gap, arrangement)
    places: dict[int, Place] = {}
    for block, center, row in zip(blocks, outer.centers, outer.depths, strict=True):
        if len(block.members) == 1:
            _deepen(sized[next(iter(block.members))], row)
        for child, within in block.members.items():
            x, y = taken[child].center
            places[child] = (center[0] + within[0] + x, center[1] + within[1] + y)
    return places, outer.width, outer.depth


def _contain_more(
    sized: Sequence[Sized],
    number: int,
    children: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
    rooms: Rooms,
    stress: Within | None = None,
) -> Contents:
    """Find room for those of ``children`` that are new, beside what stands."""
    fixed = any(not sized[child].is_free for child in children)
    places: dict[int, Place] = {}
    around = None
    kept: Iterable[int] = children
    if fixed or not _is_settled(sized, number, children):
        ground = Ground(rooms.within(number), gap, arrangement, line_ups)
        standing, near = hold(sized, children, ground)
        free = [child for child in children if child not in standing]
        _make_alike([sized[child] for child in free], [sized[child] for child in standing])
        blocks = blocks_of(sized, free, line_ups, gap)
        if stress is not None:
            near = beside_joined(blocks, standing, stress) | near
        found, around = stand(standing, near, blocks, ground)
        for child, (x, y) in found.items():
            aside = sized[child].footprint.center
            places[child] = (x + aside[0], y + aside[1])
        kept = standing
    for child in kept:
        stood = sized[child].stood
        if sized[child].is_free and stood is not None:
            places[child] = stood.offset[:2]
    return Contents(places, around, fixed)


def _off_ground(
    sized: Sequence[Sized], roots: Sequence[int], line_ups: Groups, stress: Stress
) -> dict[int, Place]:
    """Places of free roots on a sheet or in space, where each is lifted to its height."""
    free = [child for child in roots if sized[child].is_free]
    kept = [sized[child] for child in free if sized[child].is_kept]
    _make_alike([sized[child] for child in free if not sized[child].is_kept], kept)
    for line_up, members in line_ups:
        for member in members if isinstance(line_up, Helix) else ():
            sized[member].turn = own_turn(sized[member].item)
    blocks = blocks_of(sized, free, line_ups, ROOT_GAP)
    within = stress.within(-1)
    joined = [] if within is None else within.joined
    found = by_stress(
        sized,
        roots,
        blocks,
        joined,
        stress.joined.thickness,
        stress.mode,
        stress.progress,
        stress.spacing,
    )
    for child in free:
        sized[child].lift = found[child][2]
    return {child: found[child][:2] for child in free}


def _is_settled(sized: Sequence[Sized], number: int, children: Sequence[int]) -> bool:
    """Whether children stand as they stood, in a parent that is as it was, with its label."""
    if number >= 0:
        stood = sized[number].stood
        if stood is None or not (stood.alike and stood.labelled):
            return False
    return all(sized[child].is_as_before for child in children)


def _deepen(child: Sized, depth: float) -> None:
    """Trays of nearly one depth in one row end at one line; contents stay in their middle."""
    stretches = isinstance(child.solid, Tray) and not child.has_own_size and child.turn == UNTURNED
    if stretches and depth <= DEEPER * child.size[1]:
        child.resize((child.size[0], max(depth, child.size[1]), child.size[2]))


def _make_alike(siblings: Sequence[Sized], standing: Sequence[Sized] = ()) -> None:
    """Blocks of one kind in one parent look alike: the same height, and width if that is cheap.

    Those that are ``standing`` stay as they are.
    """
    kinds: dict[str | None, list[Sized]] = defaultdict(list)
    for sibling in (*siblings, *standing):
        if isinstance(sibling.solid, Box) and not sibling.has_own_size and not sibling.children:
            kinds[sibling.item.kind].append(sibling)
    remaining = {id(sibling) for sibling in standing}
    for group in kinds.values():
        widths = [sibling.size[0] for sibling in group]
        widest = max(widths) if max(widths) <= ALIKE * min(widths) else 0.0
        tallest = max(sibling.size[2] for sibling in group)
        for sibling in group:
            if id(sibling) not in remaining:
                sibling.resize((max(sibling.size[0], widest), sibling.size[1], tallest))
