"""Symbols of circuits, upright: gates, multiplexers, operators and ports of modules."""

from __future__ import annotations

import math
from dataclasses import dataclass

from app.program.base import Vector
from app.program.csg import (
    CsgBox,
    CsgCylinder,
    CsgDifference,
    CsgHalfSpace,
    CsgIntersection,
    CsgNode,
    CsgUnion,
)
from app.program.shapes import Box, Csg, Shape

DEPTH = 0.5
"""From the front of a symbol to its back, document units."""

BUBBLE = 0.09
"""Radius of the ball that inverts."""

NOTCH = 0.16
"""How deep the back of an OR gate is hollow."""

GATES = ("and", "or", "xor", "nand", "nor", "xnor", "not", "buf")
INVERTING = ("nand", "nor", "xnor", "not")
OPERATORS = {
    "add": "+", "sub": "-", "mul": "×", "div": "/", "mod": "%", "eq": "=", "ne": "≠", "lt": "<",
    "gt": ">", "le": "≤", "ge": "≥", "shl": "<<", "shr": ">>",
}  # fmt: skip
"""What is written on operators, by the plain names of their types."""


@dataclass(frozen=True, slots=True)
class Symbol:
    """What a block looks like: ``form`` is a gate's name, or what it is else.

    ``width`` and ``height`` are its size, and ``caption`` is written on it.
    """

    form: str
    width: float
    height: float
    caption: str

    @property
    def shape(self) -> Shape:
        """The shape, with its middle at the origin."""
        if self.form in ("box", "join"):
            depth = DEPTH if self.form == "box" else 0.44
            return Box(type="box", size=(self.width, depth, self.height))
        return Csg(type="csg", tree=_tree(self.form, self.width, self.height))

    def inset(self, height: float, side: int) -> float:
        """How far within the side (-1 left, 1 right) the outline is at a ``height``."""
        if self.form == "circle":
            radius = self.width / 2
            return radius - math.sqrt(max(0.01, radius * radius - height * height)) - 0.01
        if self.form in ("or", "nor", "xor", "xnor") and side < 0:
            back = 0.9 * self.height
            bulge = back - math.sqrt(max(0.0, back * back - height * height))
            return max(0.0, NOTCH - bulge)
        return 0.0


def form_of(kind: str, plain: str, *, is_own: bool) -> str:
    """What a block of a ``kind`` and with this ``plain`` type looks like.

    ``is_own`` tells whether the type is one of Yosys' own, whose names are known.

    >>> form_of("logic", "reduce_xor", is_own=True), form_of("cell", "cpu", is_own=False)
    ('xor', 'box')
    """
    if kind in ("input", "output", "join"):
        return kind
    name = plain.lower().removeprefix("reduce_").removeprefix("logic_")
    if not is_own:
        return "box"
    if name == "bool":
        return "or"
    if name in GATES:
        return name
    if name in OPERATORS:
        return "circle"
    return "mux" if kind == "mux" and "demux" not in name else "box"


def _box(x: float, width: float, height: float) -> CsgBox:
    return CsgBox(type="box", size=(width, DEPTH, height), position=(x, 0.0, 0.0))


def _round(radius: float, x: float, z: float = 0.0, depth: float = DEPTH) -> CsgCylinder:
    """A cylinder that faces the reader."""
    return CsgCylinder(
        type="cylinder",
        radius=radius,
        height=depth,
        position=(x, 0.0, z),
        rotation=(90.0, 0.0, 0.0),
    )


def _all_of(*nodes: CsgNode) -> CsgIntersection:
    return CsgIntersection(type="intersection", of=nodes)


def _any_of(*nodes: CsgNode) -> CsgUnion:
    return CsgUnion(type="union", of=nodes)


def _without(whole: CsgNode, *nodes: CsgNode) -> CsgDifference:
    return CsgDifference(type="difference", of=(whole, *nodes))


def _behind(x: float, z: float, offset: float) -> CsgHalfSpace:
    normal: Vector = (x, 0.0, z)
    return CsgHalfSpace(type="half_space", normal=normal, offset=offset)


def _tree(form: str, width: float, height: float) -> CsgNode:
    inverts = form in INVERTING
    body = width - 2 * BUBBLE if inverts else width
    left = -width / 2
    tree = _body(form, left, body, height)
    if inverts:
        return _any_of(tree, _round(BUBBLE, width / 2 - BUBBLE, depth=0.8 * DEPTH))
    return tree


def _body(form: str, left: float, width: float, height: float) -> CsgNode:
    middle = left + width / 2
    block = _box(middle, width, height)
    match form:
        case "and" | "nand":
            straight = max(width - height / 2, 0.05)
            return _all_of(
                block,
                _any_of(
                    _box(left + straight / 2, straight, height),
                    _round(height / 2, left + width - height / 2),
                ),
            )
        case "or" | "nor" | "xor" | "xnor":
            bow = (width * width + height * height / 4) / height
            back = 0.9 * height
            sides = (_round(bow, left, bow - height / 2), _round(bow, left, height / 2 - bow))
            hollow = left - back + NOTCH
            tree = _without(_all_of(block, *sides), _round(back, hollow, depth=2 * DEPTH))
            if form in ("or", "nor"):
                return tree
            line = _without(
                _round(back, hollow + 0.16, depth=2 * DEPTH),
                _round(back, hollow + 0.08, depth=4 * DEPTH),
            )
            return _without(tree, line)
        case "not" | "buf":
            return _pointed(block, left + width, math.atan2(height / 2, width))
        case "mux":
            slope = 0.45
            offset = -math.sin(slope) * width / 2 + math.cos(slope) * height / 2
            return _all_of(
                block,
                _behind(math.sin(slope), math.cos(slope), offset),
                _behind(math.sin(slope), -math.cos(slope), offset),
            )
        case "circle":
            return _round(width / 2, middle)
        case _:
            tip = min(0.3, height / 2)
            return _pointed(block, left + width, math.atan2(height / 2, tip))


def _pointed(block: CsgNode, tip: float, angle: float) -> CsgNode:
    """What is left of a block that ends in a point at its right."""
    x, z = math.sin(angle), math.cos(angle)
    return _all_of(block, _behind(x, z, x * tip), _behind(x, -z, x * tip))
