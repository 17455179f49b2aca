"""Netlists from left to right: blocks in columns by their depth from inputs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from pydantic import JsonValue

from app.formats.columns import depths, levels
from app.formats.netlist import Bit
from app.program.base import Vector
from app.program.model import AttachmentPoint, Flow, Item
from app.program.shapes import Box

PITCH = 0.36
"""Between pins on one side: room for two tubes and air."""

LONGEST_SIDE = 50_000.0
"""Sides with very many pins have them nearer together: lengths of a document have a limit."""

HEIGHT = 0.62
SIDE_MARGIN = 0.3
COLUMN_GAP = 2.6
"""Between columns: where the tubes are seen best."""

ROW_GAP = 1.1
"""Between rows: a block's label is on its front, and must not be hidden by the block before it."""

LETTER = 0.27
"""Width of a letter of a block's label, roughly; formats do not know lettering."""

WIDEST = 6.0
"""Labels that need more are fitted to this."""

PIN_DROP = 0.12
"""How far below the top edge a pin sits on its side."""


class Side(Enum):
    """Where on a block a pin is: what it takes on the left, what it gives on the right.

    Pins that do both are at the back; the label is on the front.
    """

    LEFT = (-1, 0)
    RIGHT = (1, 0)
    BACK = (0, 1)

    @property
    def flow(self) -> Flow:
        """Which way the pin's net goes, seen from the block."""
        if self is Side.BACK:
            return "both"
        return "in" if self is Side.LEFT else "out"


@dataclass(frozen=True, slots=True)
class Pin:
    """One bit of a port of a block; ``bit`` is the number of its net, or a constant."""

    id: str
    port: str
    bit: Bit
    side: Side


@dataclass(frozen=True, slots=True)
class Block:
    """What becomes an item: a cell, a module port or a constant."""

    id: str
    kind: str
    label: str
    pins: tuple[Pin, ...]
    data: Mapping[str, JsonValue] = field(default_factory=dict)

    def on(self, side: Side) -> tuple[Pin, ...]:
        """The pins on one side: from the back to the front, or from left to right."""
        return tuple(pin for pin in self.pins if pin.side is side)

    @property
    def size(self) -> Vector:
        """Room for the label at the front and for the pins at the sides."""
        beside = max(len(self.on(Side.LEFT)), len(self.on(Side.RIGHT)))
        width = min(max(1.1, LETTER * len(self.label) + 0.45), WIDEST)
        return (
            max(width, _length(len(self.on(Side.BACK)))),
            max(0.8, _length(beside)),
            HEIGHT,
        )


def arrange(blocks: Sequence[Block], nets: Sequence[Sequence[tuple[Block, Pin]]]) -> list[Item]:
    """Items for ``blocks``, placed so that nets run from left to right."""
    numbers = {block.id: number for number, block in enumerate(blocks)}
    drivers = [_ends(net, numbers, gives=True) for net in nets]
    takers = [_ends(net, numbers, gives=False) for net in nets]
    columns = _columns(blocks, drivers, takers)
    order = levels(columns, drivers, takers)
    items: list[Item] = []
    x = 0.0
    for column in order:
        width = max(blocks[number].size[0] for number in column)
        y = sum(blocks[number].size[1] + ROW_GAP for number in column) / 2 - ROW_GAP / 2
        for number in column:
            block = blocks[number]
            center = (x + width / 2, y - block.size[1] / 2, block.size[2] / 2)
            items.append(_item(block, center))
            y -= block.size[1] + ROW_GAP
        x += width + COLUMN_GAP
    return items


def _ends(
    net: Iterable[tuple[Block, Pin]], numbers: Mapping[str, int], *, gives: bool
) -> tuple[int, ...]:
    """Numbers of the blocks that drive a net, or of those that take from it; each once."""
    found = {numbers[block.id]: None for block, pin in net if (pin.side is Side.RIGHT) is gives}
    return tuple(found)


def _columns(
    blocks: Sequence[Block],
    drivers: Sequence[tuple[int, ...]],
    takers: Sequence[tuple[int, ...]],
) -> list[list[int]]:
    """Numbers of the blocks in each column: module inputs first, module outputs last."""
    kinds = [block.kind for block in blocks]
    anew = [kind in ("input", "constant", "flipflop") for kind in kinds]
    # Constants stand among the cells, so that the first column is the module's inputs alone.
    least = [0 if kind == "input" else 1 for kind in kinds]
    depth = depths(least, anew, drivers, takers)
    last = 1 + max(depth)
    nearest = {number: last for number, kind in enumerate(kinds) if kind == "constant"}
    for sources, ends in zip(drivers, takers, strict=True):
        for source in sources:
            if source in nearest:
                nearest[source] = min([nearest[source], *(depth[end] for end in ends)])
    for number, kind in enumerate(kinds):
        if kind == "output":
            depth[number] = last
        elif kind == "constant":
            # Just before what it feeds.
            depth[number] = nearest[number] - 1
    columns: dict[int, list[int]] = defaultdict(list)
    for number in range(len(blocks)):
        columns[depth[number]].append(number)
    return [columns[key] for key in sorted(columns)]


def _item(block: Block, center: Vector) -> Item:
    width, depth, height = block.size
    points = []
    for side in Side:
        pins = block.on(side)
        pitch = _pitch(len(pins))
        right, back = side.value
        for place, pin in enumerate(pins):
            along = pitch * (place - (len(pins) - 1) / 2)
            position = (
                right * width / 2 + back * along,
                back * depth / 2 - abs(right) * along,
                height / 2 - PIN_DROP,
            )
            points.append(
                AttachmentPoint(
                    id=pin.id, position=position, direction=(0.6 * right, 0.6 * back, 0.8)
                )
            )
    return Item(
        id=block.id,
        kind=block.kind,
        label=block.label,
        shape=Box(type="box", size=block.size),
        position=center,
        attachment_points=tuple(points),
        data=dict(block.data),
    )


def _pitch(pins: int) -> float:
    return min(PITCH, LONGEST_SIDE / max(pins, 1))


def _length(pins: int) -> float:
    """Of a side with so many pins."""
    return _pitch(pins) * (pins - 1) + 2 * SIDE_MARGIN if pins else 0.0
