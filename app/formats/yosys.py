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
from app.formats.netlist_ports import NOTES, is_clock, net_names, side_of
from app.formats.schematic_program import schematic_of
from app.program.checking import check
from app.program.collection import collection_paused
from app.program.model import Attachment, Hyperedge, Layout, Program
from app.program.parsing import parse
from app.program.reading import validate
from app.settings import Settings

Net = Sequence[tuple[Block, Pin]]


def read(data: bytes, settings: Settings, layout: Layout | None = None) -> Program:
    """The program that shows a netlist, laid out as ``layout`` wishes.

    In layers it is a schematic (`app.formats.schematic`), whose items have no positions. Raises
    `UnreadableDocument`, `InvalidDocument`, `InconsistentDocument` and `DocumentTooLarge`, all with
    pointers into the netlist.
    """
    with collection_paused():
        netlist = validate(Netlist, parse(data, settings))
        name = netlist.top()
        _refuse_large(name, netlist.modules[name], settings)
        _refuse_empty(name, netlist.modules[name])
        if layout is not None and layout.placement == "layers":
            program = schematic_of(name, netlist.modules[name], layout)
        else:
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


def _refuse_empty(name: str, module: Module) -> None:
    if not module.ports and all(cell.type in NOTES for cell in module.cells.values()):
        raise InconsistentDocument(
            [Fault(pointer("modules", name), "There is nothing to show: no ports and no cells.")]
        )


def _program(name: str, module: Module) -> Program:
    blocks = [*_ports(module), *_cells(module)]
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
    names = net_names(module)
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
    return pin.side is Side.LEFT and is_clock(block.kind, pin.port)


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
        side = side_of(cell, port)
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
