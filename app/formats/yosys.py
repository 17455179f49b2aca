"""Yosys netlists: cells and module ports become items, nets become hyperedges.

One module is shown (`app.formats.netlist.Netlist.top` says which). A net of two or more pins is one
hyperedge, however many pins it has. A constant (0, 1, x, z) is an item too and drives a net of its
own: one hyperedge to all pins that it feeds.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from app.errors import DocumentTooLarge, Fault, InconsistentDocument, pointer
from app.formats.cell_kinds import kind_of, plain_type
from app.formats.names import distinct, short
from app.formats.netlist import Bit, Cell, Module, Netlist, bit_names
from app.formats.netlist_layout import Block, Pin, Side, arrange
from app.program.checking import check
from app.program.collection import collection_paused
from app.program.model import Attachment, Hyperedge, Program
from app.program.parsing import parse
from app.program.reading import validate
from app.settings import Settings

Net = Sequence[tuple[Block, Pin]]

GIVING_PORTS = ("Y", "Q", "O", "OUT", "CO", "X")
"""Ports that most likely give, where a netlist does not say."""

CLOCK_PORTS = ("CLK", "CK", "CLOCK")

NOTES = ("$scopeinfo",)
"""Types of cells that carry remarks about the source and join nothing."""


def read(data: bytes, settings: Settings) -> Program:
    """The program that shows a netlist.

    Raises `UnreadableDocument`, `InvalidDocument`, `InconsistentDocument` and `DocumentTooLarge`,
    all with pointers into the netlist.
    """
    with collection_paused():
        netlist = validate(Netlist, parse(data, settings))
        name = netlist.top()
        _refuse_large(name, netlist.modules[name], settings)
        program = _program(name, netlist.modules[name])
        check(program, settings)
    return program


def _refuse_large(name: str, module: Module, settings: Settings) -> None:
    """Raise `DocumentTooLarge` before any item is made."""
    widths = [len(port.bits) for port in module.ports.values()]
    widths += [len(bits) for cell in module.cells.values() for bits in cell.connections.values()]
    faults = [
        Fault(
            pointer("modules", name),
            f"{number} {what} are more than the limit of {most} {limited}.",
        )
        for number, what, most, limited in (
            (len(module.ports) + len(module.cells), "ports and cells", settings.max_items, "items"),
            (sum(widths), "pins", settings.max_attachments, "attachments"),
        )
        if number > most
    ]
    if faults:
        raise DocumentTooLarge(faults)


def _program(name: str, module: Module) -> Program:
    blocks = [*_ports(module), *_cells(module)]
    if not blocks:
        raise InconsistentDocument(
            [Fault(pointer("modules", name), "There is nothing to show: no ports and no cells.")]
        )
    blocks += _constants(blocks)
    nets: dict[Bit, list[tuple[Block, Pin]]] = defaultdict(list)
    for block in blocks:
        for pin in block.pins:
            nets[pin.bit].append((block, pin))
    joined = {bit: pins for bit, pins in nets.items() if len(pins) > 1}
    return Program(
        name=short(name),
        notation="netlist",
        items=tuple(arrange(blocks, list(joined.values()))),
        hyperedges=tuple(_hyperedges(module, joined)),
    )


def _hyperedges(module: Module, nets: Mapping[Bit, Net]) -> Iterator[Hyperedge]:
    names = _net_names(module)
    for bit, pins in nets.items():
        constant = isinstance(bit, str)
        yield Hyperedge(
            id=f"constant:{bit}" if constant else f"net:{bit}",
            kind="clock" if not constant and any(_is_clocked(*end) for end in pins) else "net",
            label=short(str(bit) if constant else names.get(bit, f"net {bit}")),
            attachments=tuple(
                Attachment(item=block.id, point=pin.id, flow=pin.side.flow) for block, pin in pins
            ),
        )


def _is_clocked(block: Block, pin: Pin) -> bool:
    if pin.side is not Side.LEFT:
        return False
    port = pin.port.upper()
    return port in CLOCK_PORTS or (port == "C" and block.kind == "flipflop")


def _ports(module: Module) -> Iterator[Block]:
    for name, port in module.ports.items():
        # Seen from inside the module an input gives, to its right.
        gives = port.direction != "output"
        side = Side.RIGHT if gives else Side.LEFT
        names = bit_names(name, len(port.bits), port.offset, port.upto)
        yield Block(
            id=f"port:{distinct(name)}",
            kind="input" if gives else "output",
            label=short(name),
            pins=tuple(
                Pin(distinct(full), name, bit, side)
                for full, bit in zip(names, port.bits, strict=True)
            ),
            data={"port": name, "direction": port.direction},
        )


def _cells(module: Module) -> Iterator[Block]:
    for name, cell in module.cells.items():
        if cell.type not in NOTES:
            yield Block(
                id=f"cell:{distinct(name)}",
                kind=kind_of(cell.type),
                label=short(plain_type(cell.type)),
                pins=tuple(_pins(cell)),
                data={
                    "cell": name,
                    "type": cell.type,
                    "parameters": cell.parameters,
                    "attributes": cell.attributes,
                },
            )


def _pins(cell: Cell) -> Iterator[Pin]:
    # A port that is called "A[0]" itself has its own name first, and port "A" yields.
    taken = set(cell.connections)
    for port, bits in cell.connections.items():
        side = _side(cell, port)
        for name, bit in zip(bit_names(port, len(bits)), bits, strict=True):
            full = name
            while full != port and full in taken:
                full += "'"
            taken.add(full)
            yield Pin(distinct(full), port, bit, side)


def _constants(blocks: Iterable[Block]) -> list[Block]:
    values = {pin.bit for block in blocks for pin in block.pins if isinstance(pin.bit, str)}
    return [
        Block(f"constant:{value}", "constant", value, (Pin(value, value, value, Side.RIGHT),))
        for value in sorted(values)
    ]


def _side(cell: Cell, port: str) -> Side:
    direction = cell.port_directions.get(port)
    if direction is None:
        return Side.RIGHT if port.upper() in GIVING_PORTS else Side.LEFT
    return {"input": Side.LEFT, "output": Side.RIGHT, "inout": Side.BACK}[direction]


def _net_names(module: Module) -> dict[Bit, str]:
    """The best name of each net: a visible one before a hidden one, then the shortest."""
    best: dict[Bit, tuple[bool, int, str]] = {}
    for name, net in module.netnames.items():
        names = bit_names(name, len(net.bits), net.offset, net.upto)
        for full, bit in zip(names, net.bits, strict=True):
            rank = (bool(net.hide_name), len(full), full)
            best[bit] = min(best.get(bit, rank), rank)
    return {bit: rank[2] for bit, rank in best.items()}
