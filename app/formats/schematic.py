"""Netlists as schematics: symbols with ports on their sides, to be placed in layers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from pydantic import JsonValue

from app.formats.names import untaken
from app.formats.schematic_pins import Pin
from app.formats.symbols import DEPTH, OPERATORS, Symbol, form_of
from app.program.base import Vector
from app.program.model import AttachmentPoint, Item
from app.program.port_rows import ROW, rows_beside
from app.program.shapes import Text

LETTER, SMALL, LARGE = 0.24, 0.15, 0.42
"""Heights of capital letters: of names, of ports' names, and of operators."""

NOTE = 0.13
"""Height of the capital letters of ranges."""

VALUE = 0.22
"""Height of the capital letters of constants."""

WIDTH = 0.78
"""Of a letter over the height of a capital one, roughly; formats do not know lettering."""

NAME = 0.45
"""Room for a name above the ports of a block."""

UPRIGHT: Vector = (90.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Block:
    """What becomes an item; ``plain`` is its type as people say it, ``label`` what it is called."""

    id: str
    kind: str
    label: str
    plain: str
    is_own: bool
    data: Mapping[str, JsonValue]


def join_block(number: int) -> Block:
    """A bar at which runs come together."""
    return Block(f"join:{number}", "join", "", "join", False, {})


def items_of(block: Block, pins: Sequence[Pin]) -> Iterator[Item]:
    """The item of a block, and the letters on and beside it."""
    left, right = ([pin for pin in pins if pin.side == side] for side in (-1, 1))
    rows = rows_beside(len(left), len(right))
    last = max([0, *rows[0], *rows[1]])
    symbol = symbol_of(block, left, right, last)
    # A block's name stands above its ports.
    middle = -NAME / 2 if _has_name_above(symbol, last) else 0.0
    heights = {
        pin.id: ROW * (last / 2 - row) + middle
        for pin, row in zip([*left, *right], [*rows[0], *rows[1]], strict=True)
    }
    yield Item(
        id=block.id,
        kind=block.kind,
        label=block.label or None,
        shape=symbol.shape,
        attachment_points=tuple(
            AttachmentPoint(
                id=pin.id,
                position=(
                    pin.side * _side(symbol, heights[pin.id], pin.side),
                    0.0,
                    heights[pin.id],
                ),
                direction=(float(pin.side), 0.0, 0.0),
            )
            for pin in (*left, *right)
            if pin.constant is None
        ),
        data=dict(block.data),
    )
    taken: set[str] = set()
    for kind, name, text, height, place, anchor in _letters(block, symbol, pins, heights, last):
        x, y, z = place
        yield Item(
            id=untaken(f"{block.id}/{name}", taken),
            kind=kind,
            label=text,
            parent=block.id,
            shape=Text(type="text", height=height, depth=0.02),
            position=(x - anchor * width_of(text, height) / 2, y, z),
            rotation=UPRIGHT,
        )


def symbol_of(block: Block, left: Sequence[Pin], right: Sequence[Pin], last: int) -> Symbol:
    """The symbol of a block with pins in rows 0 to ``last``, large enough for its letters."""
    form = form_of(block.kind, block.plain, is_own=block.is_own)
    height = last * ROW + (0.6 if last == 0 else 0.56)
    label = block.label
    if form == "circle" and last > 2:
        form = "box"
    match form:
        case "join":
            return Symbol(form, 0.16 if len(left) == 2 else 0.45, height, "")
        case "and" | "or" | "xor" | "nand" | "nor" | "xnor":
            return Symbol(form, max(0.9, 0.95 * height), height, "")
        case "not" | "buf":
            return Symbol(form, 0.7 if form == "not" else 0.6, height, "")
        case "circle":
            size = max(0.9, 0.8 * height)
            return Symbol(form, size, size, OPERATORS[block.plain.lower()])
        case "mux":
            return Symbol(form, 0.75, height, "")
        case "input" | "output":
            return Symbol(form, max(0.8, width_of(label, LETTER) + 0.45), height, label)
    beside = sum(
        max((width_of(pin.port, SMALL) for pin in side), default=0.0) for side in (left, right)
    )
    width = max(1.1, width_of(label, LETTER) + 0.4, beside + 0.5)
    symbol = Symbol("box", width, height, label)
    return Symbol("box", width, height + NAME, label) if _has_name_above(symbol, last) else symbol


def _has_name_above(symbol: Symbol, last: int) -> bool:
    return symbol.form == "box" and last > 0


def _side(symbol: Symbol, height: float, side: int) -> float:
    return symbol.width / 2 - symbol.inset(height, side)


def width_of(text: str, height: float) -> float:
    """Width of letters, roughly, document units."""
    return WIDTH * height * len(text)


def _letters(
    block: Block, symbol: Symbol, pins: Sequence[Pin], heights: Mapping[str, float], last: int
) -> Iterator[tuple[str, str, str, float, Vector, int]]:
    """Kind, name, text, height, place and anchor (-1: its left end, 1: its right) of letters."""
    front = 0.003 - DEPTH / 2
    if symbol.caption:
        place = (0.0, front, 0.0)
        if block.kind == "input":
            place = (-0.08, front, 0.0)
        elif _has_name_above(symbol, last):
            place = (0.0, front, symbol.height / 2 - LETTER)
        height = LARGE if symbol.form == "circle" else LETTER
        yield "caption", "name", symbol.caption, height, place, 0
    named = symbol.form in ("box", "mux") and len(pins) > 1
    for pin in pins:
        z, side = heights[pin.id], pin.side
        edge = _side(symbol, z, side)
        if named:
            yield "port", f"port {pin.id}", pin.port, SMALL, (side * (edge - 0.08), front, z), side
        beside = 0.22 if symbol.form == "circle" and last > 1 else 0.1
        if pin.constant is not None:
            x = side * (edge + beside)
            yield "value", f"value {pin.id}", pin.constant, VALUE, (x, 0.0, z), -side
        elif pin.note:
            up = z + radius_of(pin.bits) + 0.155
            x = side * (symbol.width / 2 + 0.06)
            yield "range", f"range {pin.id}", pin.note, NOTE, (x, 0.0, up), -side


def radius_of(bits: int) -> float:
    """Radius of a tube for so many bits."""
    return min(0.14, 0.045 * math.sqrt(bits))
