"""Yosys netlists: cells and module ports become items, nets become hyperedges.

The module shown is the one marked as top, else the first that no other module instantiates. A net
of two or more pins is one hyperedge, however many pins it has. A constant (0, 1, x, z) is an item
too and drives a net of its own: one hyperedge to all pins that it feeds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field

from app.errors import Fault, InconsistentDocument
from app.formats.netlist_layout import Block, Pin, arrange
from app.program.base import Data
from app.program.checking import check
from app.program.model import Attachment, Hyperedge, Program
from app.program.reading import validate
from app.settings import Settings

Direction = Literal["input", "output", "inout"]


def _whole(number: object) -> object:
    """JSON knows no integers: 3.0 is 3."""
    return int(number) if isinstance(number, float) and number.is_integer() else number


Bit = Annotated[int, Field(ge=0), BeforeValidator(_whole)] | Literal["0", "1", "x", "z"]
Name = Annotated[str, Field(min_length=1, max_length=150)]

GIVING_PORTS = ("Y", "Q", "O", "OUT", "CO", "X")
"""Ports that most likely give, where a netlist does not say."""

KINDS = {
    "flipflop": ("dff", "sdff", "adff", "dlatch", "ff", "sr"),
    "mux": ("mux", "pmux", "bmux", "demux"),
    "arithmetic": ("add", "sub", "mul", "div", "mod", "neg", "alu", "macc", "fa", "lcu", "pow",
                   "lt", "le", "eq", "ne", "ge", "gt", "shl", "shr", "sshl", "sshr", "shift"),
    "logic": ("and", "or", "xor", "xnor", "nand", "nor", "not", "buf", "logic", "reduce", "pos"),
}  # fmt: skip
"""Kinds of cells, by how their types begin (the first that fits)."""


class _Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class Port(_Section):
    """A port of a module."""

    direction: Direction
    bits: tuple[Bit, ...]


class Cell(_Section):
    """A cell of a module."""

    type: Annotated[str, Field(max_length=400)]
    connections: dict[Name, tuple[Bit, ...]]
    port_directions: dict[Name, Direction] = Field(default_factory=dict)
    parameters: Data = Field(default_factory=dict)
    attributes: Data = Field(default_factory=dict)


class NetName(_Section):
    """A name for some nets."""

    bits: tuple[Bit, ...] = ()
    hide_name: Annotated[int, BeforeValidator(_whole)] = 0


class Module(_Section):
    """A module: what is drawn."""

    attributes: Data = Field(default_factory=dict)
    ports: dict[Name, Port] = Field(default_factory=dict)
    cells: dict[Name, Cell] = Field(default_factory=dict)
    netnames: dict[str, NetName] = Field(default_factory=dict)


class Netlist(_Section):
    """A Yosys netlist, as written by ``write_json``; parts that are not drawn are left out."""

    modules: dict[str, Module] = Field(min_length=1)


def read(data: bytes, settings: Settings) -> Program:
    """The program that shows a netlist.

    Raises `UnreadableDocument`, `InvalidDocument` with pointers into the netlist, and what
    `app.program.checking.check` raises.
    """
    netlist = validate(Netlist, data)
    name = _top(netlist.modules)
    program = _program(name, netlist.modules[name])
    check(program, settings)
    return program


def _top(modules: Mapping[str, Module]) -> str:
    for name, module in modules.items():
        if str(module.attributes.get("top", "0")).strip("0"):
            return name
    inner = {cell.type for module in modules.values() for cell in module.cells.values()}
    return next((name for name in modules if name not in inner), next(iter(modules)))


def _program(name: str, module: Module) -> Program:
    blocks = [*_ports(module), *_cells(module)]
    blocks += _constants(blocks)
    if not blocks:
        raise InconsistentDocument(
            [Fault("/modules", f'Module "{name[:40]}" has no ports or cells.')]
        )
    nets: dict[int | str, list[tuple[Block, Pin]]] = defaultdict(list)
    for block in blocks:
        for pin in block.pins:
            nets[pin.bit].append((block, pin))
    joined = {bit: pins for bit, pins in nets.items() if len(pins) > 1}
    return Program(
        name=name[:500],
        notation="netlist",
        items=tuple(arrange(blocks, joined.values())),
        hyperedges=tuple(_nets(module, joined)),
    )


def _nets(
    module: Module, nets: Mapping[int | str, Iterable[tuple[Block, Pin]]]
) -> Iterator[Hyperedge]:
    names = _net_names(module)
    for bit, pins in nets.items():
        clocked = any(
            block.kind == "flipflop" and pin.port.upper() in ("CLK", "CK", "C")
            for block, pin in pins
        )
        yield Hyperedge(
            id=f"net:{bit}" if isinstance(bit, int) else f"constant:{bit}",
            kind="clock" if clocked else "net",
            label=(names.get(bit, f"net {bit}") if isinstance(bit, int) else bit)[:500],
            attachments=tuple(Attachment(item=block.id, point=pin.id) for block, pin in pins),
        )


def _constants(blocks: Iterable[Block]) -> list[Block]:
    values = {pin.bit for block in blocks for pin in block.pins if isinstance(pin.bit, str)}
    return [
        Block(f"constant:{value}", "constant", value, (Pin(value, value, value, 1),))
        for value in sorted(values)
    ]


def _ports(module: Module) -> Iterator[Block]:
    for name, port in module.ports.items():
        # Seen from inside the module an input gives, to its right.
        side = -1 if port.direction == "output" else 1
        yield Block(
            id=f"port:{name}",
            kind="output" if port.direction == "output" else "input",
            label=name,
            pins=tuple(_pins(name, port.bits, side)),
            data={"direction": port.direction},
        )


def _cells(module: Module) -> Iterator[Block]:
    for name, cell in module.cells.items():
        pins = [
            pin
            for port, bits in cell.connections.items()
            for pin in _pins(port, bits, _side(cell, port))
        ]
        yield Block(
            id=f"cell:{name}",
            kind=_kind(cell.type),
            label=cell.type.lstrip("$\\").strip("_") or cell.type,
            pins=tuple(pins),
            data={
                "cell": name,
                "type": cell.type,
                "parameters": cell.parameters,
                "attributes": cell.attributes,
            },
        )


def _pins(port: str, bits: tuple[Bit, ...], side: int) -> Iterator[Pin]:
    for place, bit in enumerate(bits):
        yield Pin(port if len(bits) == 1 else f"{port}[{place}]", port, bit, side)


def _side(cell: Cell, port: str) -> int:
    direction = cell.port_directions.get(port)
    if direction is None:
        return 1 if port.upper() in GIVING_PORTS else -1
    return 1 if direction == "output" else -1


def _kind(cell_type: str) -> str:
    plain = cell_type.lstrip("$\\").strip("_").lower()
    for kind, beginnings in KINDS.items():
        if plain.startswith(beginnings):
            return kind
    return "cell"


def _net_names(module: Module) -> dict[int, str]:
    """The best name of each net: a visible one before a hidden one, then the shortest."""
    best: dict[int, tuple[bool, int, str]] = {}
    for name, net in module.netnames.items():
        for place, bit in enumerate(net.bits):
            if isinstance(bit, int):
                full = name if len(net.bits) == 1 else f"{name}[{place}]"
                rank = (bool(net.hide_name), len(full), full)
                best[bit] = min(best.get(bit, rank), rank)
    return {bit: rank[2] for bit, rank in best.items()}
