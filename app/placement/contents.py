"""Sizes from the inside out: every item around what it contains."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.notations.notation import ItemStyle
from app.placement.family import Family
from app.placement.fitting import fit, shape_of
from app.placement.helix import Bulk, leaning, wind
from app.placement.labels import strip
from app.placement.rows import Arrangement, arrange
from app.placement.sized import Place, Sized, alone
from app.placement.standing import Standing, recall
from app.placement.still import Block, hold, shift, stand, stays
from app.placement.turning import UNTURNED, then
from app.program.model import Helix, LineUp, Program
from app.solids.extents import size_of
from app.solids.solid import Box, Tray

CAPTION_GAP = 0.1
"""Between a tray's contents and the label before them."""

SIDE_CAPTION_GAP = 0.16
"""Between a tray's contents and the label to their left: seen from the usual view, a little to the
right, a block hides a fifth of its height of what lies on its left, some 0.12."""

ROOT_GAP = 0.6

ALIKE = 1.7
"""Blocks of one kind in one parent get one width where the widest is at most so many times as wide
as the narrowest."""

DEEPER = 1.4
"""How far a tray is stretched at most, to be as deep as its neighbours."""

Groups = Sequence[tuple[LineUp | Helix, list[int]]]
"""What stands together, with its members in order."""


@dataclass(frozen=True, slots=True)
class Contents:
    """Children arranged about a point: places of the free ones, and the box around all."""

    places: dict[int, Place]
    low: Place
    high: Place
    fixed: bool
    """Whether some have positions, so that nothing may be shifted."""
    still: bool = False
    """Whether some stand where they stood before an edit."""


def measure(
    program: Program,
    family: Family,
    styles: Sequence[ItemStyle],
    standing: Standing | None = None,
) -> tuple[list[Sized], dict[int, Place]]:
    """All items with their solids, and the places of free roots in the world.

    What is ``standing`` stays where it is, as far as there is room for what has changed.

    Raises `InconsistentDocument` and `DocumentTooLarge` for trees of solids that come to no body.
    """
    line_ups = _line_ups(program, family)
    sized = alone(program, family, styles)
    if standing is not None:
        recall(sized, program, family, standing)
    for number in reversed(family.order):
        children = family.children[number]
        if children:
            style = styles[number]
            contents = contain(
                sized, children, line_ups.get(number, []), style.gap, style.arrangement
            )
            if contents.still:
                _grow(sized, number, children, contents)
            else:
                _enclose(sized[number], contents)
    roots = contain(sized, family.roots, line_ups.get(-1, []), ROOT_GAP, "rows")
    return sized, roots.places


def contain(
    sized: Sequence[Sized],
    children: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
) -> Contents:
    """Arrange the free ones of ``children``; those with positions stay, and what stood."""
    if stays(sized, children):
        return _contain_more(sized, children, line_ups, gap, arrangement)
    free = [child for child in children if sized[child].is_free]
    _make_alike([sized[child] for child in free])
    places, width, depth = _arrange_free(sized, free, line_ups, gap, arrangement)
    fixed = [sized[child] for child in children if not sized[child].is_free]
    if not fixed:
        return Contents(places, (-width / 2, -depth / 2), (width / 2, depth / 2), fixed=False)
    low, high = _bounds(fixed)
    if free:
        # The free ones stand before the box of those with positions.
        x = (low[0] + high[0]) / 2
        y = low[1] - gap - depth / 2
        places = {child: (x + place[0], y + place[1]) for child, place in places.items()}
        low = (min(low[0], x - width / 2), y - depth / 2)
        high = (max(high[0], x + width / 2), high[1])
    return Contents(places, low, high, fixed=True)


def _arrange_free(
    sized: Sequence[Sized],
    free: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
) -> tuple[dict[int, Place], float, float]:
    """Places about the centre, width and depth; what lines up is arranged first, then as one."""
    taken = {child: sized[child].footprint for child in free}
    blocks = _blocks(sized, free, line_ups, gap)
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
    children: Sequence[int],
    line_ups: Groups,
    gap: float,
    arrangement: Arrangement,
) -> Contents:
    """Find room for those of ``children`` that are new, beside what stands."""
    standing = hold(sized, children)
    free = [child for child in children if child not in standing]
    _make_alike(
        [sized[child] for child in free], [sized[child] for child in children if child in standing]
    )
    blocks = _blocks(sized, free, line_ups, gap)
    found, (left, near, right, far) = stand(standing, blocks, gap, arrangement)
    places: dict[int, Place] = {}
    for child, (x, y) in found.items():
        aside = sized[child].footprint.center
        places[child] = (x + aside[0], y + aside[1])
    for child in standing:
        stood = sized[child].stood
        if sized[child].is_free and stood is not None:
            places[child] = stood.offset[:2]
    fixed = any(not sized[child].is_free for child in children)
    return Contents(places, (left, near), (right, far), fixed, still=True)


def _blocks(
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


def _deepen(child: Sized, depth: float) -> None:
    """Trays of nearly one depth in one row end at one line; contents stay in their middle."""
    stretches = isinstance(child.solid, Tray) and not child.has_own_size and child.turn == UNTURNED
    if isinstance(child.solid, Tray) and stretches and depth <= DEEPER * child.size[1]:
        size = (child.size[0], max(depth, child.size[1]), child.size[2])
        child.solid, child.size = replace(child.solid, size=size), size


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
            if id(sibling) in remaining:
                continue
            size = (max(sibling.size[0], widest), sibling.size[1], tallest)
            if isinstance(sibling.solid, Box):
                sibling.solid, sibling.size = replace(sibling.solid, size=size), size


def _bounds(items: Sequence[Sized]) -> tuple[Place, Place]:
    lows: list[Place] = []
    highs: list[Place] = []
    for sized in items:
        x, y, _ = sized.item.position or (0.0, 0.0, 0.0)
        taken, middle = sized.footprint, sized.middle
        x, y = x + middle[0] - taken.center[0], y + middle[1] - taken.center[1]
        width, depth = taken.size
        lows.append((x - width / 2, y - depth / 2))
        highs.append((x + width / 2, y + depth / 2))
    return (
        (min(low[0] for low in lows), min(low[1] for low in lows)),
        (max(high[0] for high in highs), max(high[1] for high in highs)),
    )


def _enclose(parent: Sized, contents: Contents) -> None:
    """Give ``parent`` its size around ``contents``, and its free children their places."""
    beside, before = _caption(parent)
    (left, near), (right, far) = contents.low, contents.high
    if contents.fixed:
        # Positions are relative to the parent's centre, which therefore cannot move.
        width = 2 * max(right, beside - left)
        depth = 2 * max(far, before - near)
        parent.children = contents.places
    else:
        width, depth = right - left + beside, far - near + before
        parent.children = {
            child: (x + beside / 2, y + before / 2) for child, (x, y) in contents.places.items()
        }
    margin = 2 * parent.style.padding
    _fit(parent, width + margin, depth + margin)


def _grow(sized: Sequence[Sized], number: int, children: Sequence[int], contents: Contents) -> None:
    """Let a parent reach around ``contents`` too, and move nothing that stands in it."""
    parent = sized[number]
    parent.children = contents.places
    new = any(sized[child].grew or not _is_as_before(sized[child]) for child in children)
    if parent.stood is not None and parent.stood.alike and not new:
        return
    beside, before = _caption(parent)
    padding = parent.style.padding
    (left, near), (right, far) = contents.low, contents.high
    left, near = left - beside - padding, near - before - padding
    right, far = right + padding, far + padding
    if parent.stood is not None and parent.stood.alike:
        wall = parent.solid.wall if isinstance(parent.solid, Tray) else 0.0
        width, depth = parent.size[0] / 2 - wall, parent.size[1] / 2 - wall
        left, near = min(left, -width), min(near, -depth)
        right, far = max(right, width), max(far, depth)
    size = parent.size
    if contents.fixed or not parent.is_kept:
        _fit(parent, 2 * max(right, -left), 2 * max(far, -near))
    else:
        _fit(parent, right - left, far - near)
        if not parent.has_own_size:
            shift(sized, parent, children, ((left + right) / 2, (near + far) / 2))
    parent.grew = parent.size != size


def _is_as_before(child: Sized) -> bool:
    return child.stood is not None and child.stood.alike


def _caption(parent: Sized) -> Place:
    """Room that a tray's label takes: to the left of its contents, and before them."""
    if not isinstance(parent.solid, Tray) or parent.label is None:
        return 0.0, 0.0
    if parent.style.caption == "left":
        return parent.label.width + SIDE_CAPTION_GAP, 0.0
    return 0.0, strip(parent.label) + CAPTION_GAP


def _fit(parent: Sized, width: float, depth: float) -> None:
    """Give ``parent`` its size: so much within its walls, and its label's."""
    style = parent.style
    if isinstance(parent.solid, Tray) and parent.label is not None:
        margin = 2 * style.padding
        if style.caption == "front":
            width = max(width, parent.label.width + margin)
        if style.caption == "left":
            depth = max(depth, strip(parent.label) + margin)
    shape = shape_of(parent.item, style, has_children=True)
    parent.solid = fit(shape, parent.item, style, parent.label, (width, depth))
    parent.size = size_of(parent.solid)


def _line_ups(
    program: Program, family: Family
) -> dict[int, list[tuple[LineUp | Helix, list[int]]]]:
    numbers = {item.id: number for number, item in enumerate(program.items)}
    found: dict[int, list[tuple[LineUp | Helix, list[int]]]] = defaultdict(list)
    for line_up in program.layout.constraints:
        members = [numbers[name] for name in line_up.items]
        found[family.parents[members[0]]].append((line_up, members))
    return found
