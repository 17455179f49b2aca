"""Netlists from left to right: blocks in columns by their depth from inputs and constants."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from pydantic import JsonValue

from app.program.base import Vector
from app.program.model import AttachmentPoint, Item
from app.program.shapes import Box

SOURCES = ("input", "constant")
"""Kinds that stand in the first column."""

PITCH = 0.36
"""Between pins on one side: room for two tubes and air."""

HEIGHT = 0.62
SIDE_MARGIN = 0.3
COLUMN_GAP = 2.6
"""Between columns: where the tubes are seen best."""

ROW_GAP = 0.7
LETTER = 0.27
"""Width of a letter of a block's label, roughly; formats do not know lettering."""

PIN_DROP = 0.12
"""How far below the top edge a pin sits on its side."""


@dataclass(frozen=True, slots=True)
class Pin:
    """One bit of a port of a block: ``side`` is -1 on the left, 1 on the right."""

    id: str
    port: str
    bit: int | str
    side: int


@dataclass(frozen=True, slots=True)
class Block:
    """What becomes an item: a cell, a module port or a constant."""

    id: str
    kind: str
    label: str
    pins: tuple[Pin, ...]
    data: Mapping[str, JsonValue] = field(default_factory=dict)

    def on_side(self, side: int) -> tuple[Pin, ...]:
        """The pins on one side, the first at the back."""
        return tuple(pin for pin in self.pins if pin.side == side)

    @property
    def size(self) -> Vector:
        """Room for the label at the front and for the pins at the sides."""
        pins = max(len(self.on_side(-1)), len(self.on_side(1)))
        width = max(1.1, LETTER * len(self.label) + 0.45)
        return (min(width, 6.0), max(0.8, PITCH * (pins - 1) + 2 * SIDE_MARGIN), HEIGHT)


def arrange(blocks: Sequence[Block], nets: Iterable[Sequence[tuple[Block, Pin]]]) -> list[Item]:
    """Items for ``blocks``, placed so that nets run from left to right."""
    drives: dict[str, list[str]] = defaultdict(list)
    for net in nets:
        for driver, _ in (end for end in net if end[1].side > 0):
            drives[driver.id].extend(taker.id for taker, pin in net if pin.side < 0)
    columns = _columns(blocks, _depths(blocks, drives))
    _order_by_neighbours(columns, drives)
    items: list[Item] = []
    x = 0.0
    for column in columns:
        width = max(block.size[0] for block in column)
        y = sum(block.size[1] + ROW_GAP for block in column) / 2 - ROW_GAP / 2
        for block in column:
            center = (x + width / 2, y - block.size[1] / 2, block.size[2] / 2)
            items.append(_item(block, center))
            y -= block.size[1] + ROW_GAP
        x += width + COLUMN_GAP
    return items


def _depths(blocks: Sequence[Block], drives: Mapping[str, Sequence[str]]) -> dict[str, int]:
    """Longest way from an input; flip-flops start anew, and so does one block of each circle."""
    starts_anew = {block.id for block in blocks if block.kind in (*SOURCES, "flipflop")}
    waiting: dict[str, int] = {block.id: 0 for block in blocks}
    for takers in drives.values():
        for taker in takers:
            if taker not in starts_anew:
                waiting[taker] += 1
    depths = {block.id: 0 if block.kind in SOURCES else 1 for block in blocks}
    ready = [block.id for block in blocks if waiting[block.id] == 0]
    left = {block.id: None for block in blocks}
    while left:
        if not ready:
            ready.append(next(iter(left)))
        name = ready.pop(0)
        if name not in left:
            continue
        del left[name]
        for taker in drives.get(name, ()):
            if taker in starts_anew or taker not in left:
                continue
            depths[taker] = max(depths[taker], depths[name] + 1)
            waiting[taker] -= 1
            if waiting[taker] == 0:
                ready.append(taker)
    last = 1 + max(depths.values())
    for block in blocks:
        if block.kind == "output":
            depths[block.id] = last
    return depths


def _columns(blocks: Sequence[Block], depths: Mapping[str, int]) -> list[list[Block]]:
    columns: dict[int, list[Block]] = defaultdict(list)
    for block in blocks:
        columns[depths[block.id]].append(block)
    return [columns[depth] for depth in sorted(columns)]


def _order_by_neighbours(columns: list[list[Block]], drives: Mapping[str, Sequence[str]]) -> None:
    """Put each block level with what drives it (barycentres, from left to right)."""
    drivers: dict[str, list[str]] = defaultdict(list)
    for driver, takers in drives.items():
        for taker in takers:
            drivers[taker].append(driver)
    levels: dict[str, float] = {}
    for column in columns:
        wanted = {}
        for place, block in enumerate(column):
            seen = [levels[name] for name in drivers[block.id] if name in levels]
            wanted[block.id] = sum(seen) / len(seen) if seen else place / len(column)
        column.sort(key=lambda block: wanted[block.id])
        levels.update({block.id: (n + 0.5) / len(column) for n, block in enumerate(column)})


def _item(block: Block, center: Vector) -> Item:
    width, _, height = block.size
    points = []
    for side in (-1, 1):
        pins = block.on_side(side)
        for place, pin in enumerate(pins):
            y = PITCH * ((len(pins) - 1) / 2 - place)
            position = (side * width / 2, y, height / 2 - PIN_DROP)
            points.append(
                AttachmentPoint(id=pin.id, position=position, direction=(0.6 * side, 0.0, 0.8))
            )
    return Item(
        id=block.id,
        kind=block.kind,
        label=block.label[:500],
        shape=Box(type="box", size=block.size),
        position=center,
        attachment_points=tuple(points),
        data=dict(block.data),
    )
