"""A Yosys netlist as ``write_json`` makes it; what is not drawn is left out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from app.program.base import Data, Many, Section, Tallied


def _whole(number: object) -> object:
    """JSON knows no integers: 3.0 is 3."""
    return int(number) if isinstance(number, float) and number.is_integer() else number


Whole = Annotated[int, Field(ge=0, le=2**53), BeforeValidator(_whole)]
"""A whole number that every reader of JSON takes for the same."""

Direction = Annotated[Literal["input", "output", "inout"], Tallied]
Bit = Annotated[Whole | Literal["0", "1", "x", "z"], Tallied]
"""The number of a net, or a constant."""

Name = Annotated[str, Field(min_length=1)]


class Port(Section):
    """A port of a module; ``offset`` and ``upto`` say how its bits are numbered in the source."""

    direction: Direction
    bits: Many[Bit]
    offset: int = 0
    upto: Whole = 0


class Cell(Section):
    """A cell of a module."""

    type: str
    connections: dict[Name, Many[Bit]]
    port_directions: dict[Name, Direction] = Field(default_factory=dict)
    parameters: Data = Field(default_factory=dict)
    attributes: Data = Field(default_factory=dict)


class NetName(Section):
    """A name for some nets."""

    bits: Many[Bit] = ()
    hide_name: Whole = 0
    offset: int = 0
    upto: Whole = 0


class Module(Section):
    """A module."""

    attributes: Data = Field(default_factory=dict)
    ports: dict[Name, Port] = Field(default_factory=dict)
    cells: dict[Name, Cell] = Field(default_factory=dict)
    netnames: dict[str, NetName] = Field(default_factory=dict)


class Netlist(Section):
    """A netlist."""

    modules: dict[str, Module] = Field(min_length=1)

    def top(self) -> str:
        """The name of the module that is drawn.

        It is the one marked as top; else the first that no other one instantiates and that is more
        than a black box, if there is one with cells; else the first.
        """
        for name, module in self.modules.items():
            # Yosys writes numbers as strings of bits.
            if str(module.attributes.get("top", "0")).strip("0"):
                return name
        inner = {cell.type for module in self.modules.values() for cell in module.cells.values()}
        outer = [
            name
            for name, module in self.modules.items()
            if name not in inner and not {"blackbox", "whitebox"} & module.attributes.keys()
        ]
        with_cells = [name for name in outer if self.modules[name].cells]
        return next(iter(with_cells or outer or self.modules))


def bit_names(name: str, width: int, offset: int = 0, upto: int = 0) -> list[str]:
    """Names of the bits of a port or wire, numbered as in its source.

    >>> bit_names("A", 1), bit_names("A", 2, offset=4), bit_names("A", 2, upto=1)
    (['A'], ['A[4]', 'A[5]'], ['A[1]', 'A[0]'])
    """
    if width == 1:
        return [name]
    numbers = range(offset + width - 1, offset - 1, -1) if upto else range(offset, offset + width)
    return [f"{name}[{number}]" for number in numbers]
