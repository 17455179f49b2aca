"""The program of a netlist that is drawn as a schematic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from app.formats.buses import Buses, Port, Run, buses
from app.formats.cell_kinds import kind_of, plain_type
from app.formats.names import distinct, short
from app.formats.netlist import Bit, Module
from app.formats.netlist_layout import Side
from app.formats.netlist_ports import NOTES, is_clock, net_names, side_of
from app.formats.schematic import Block, items_of, join_block, radius_of
from app.formats.schematic_pins import Pin, Pins, pins_of, ranges
from app.program.model import Attachment, Flow, Hyperedge, Layout, Program, Style


def schematic_of(name: str, module: Module, layout: Layout) -> Program:
    """A module with its buses as one hyperedge each, where ``layout`` wishes so or says nothing."""
    blocks = [*_port_blocks(module), *_cell_blocks(module)]
    ports, sides = _ports(module)
    found = buses(ports, len(blocks), single=layout.bundles == "none")
    blocks += [join_block(number) for number in found.joins]
    sides += [Side.RIGHT if port.gives else Side.LEFT for port in found.ports[len(sides) :]]
    numbering = {
        number: (port.offset, port.upto) for number, port in enumerate(module.ports.values())
    }
    pins, of_block = pins_of(found, numbering)
    of_block += [[] for _ in range(len(blocks) - len(of_block))]
    names = net_names(module)
    return Program(
        name=short(name),
        notation="netlist",
        items=tuple(
            item
            for block, group in zip(blocks, of_block, strict=True)
            for item in items_of(block, group)
        ),
        hyperedges=tuple(_hyperedges(found, blocks, sides, pins, names)),
        style=Style(ground=False, labels=False),
    )


def _port_blocks(module: Module) -> Iterator[Block]:
    for name, port in module.ports.items():
        kind = "output" if port.direction == "output" else "input"
        data = {"port": name, "direction": port.direction}
        yield Block(f"port:{distinct(name)}", kind, short(name), kind, False, data)


def _cell_blocks(module: Module) -> Iterator[Block]:
    for name, cell in module.cells.items():
        if cell.type not in NOTES:
            plain = plain_type(cell.type)
            yield Block(
                f"cell:{distinct(name)}",
                kind_of(cell.type),
                short(plain),
                plain,
                cell.type.startswith("$"),
                {
                    "cell": name,
                    "type": cell.type,
                    "parameters": cell.parameters,
                    "attributes": cell.attributes,
                },
            )


def _ports(module: Module) -> tuple[list[Port], list[Side]]:
    """The ports of all blocks, in their order, and the sides that they are on."""
    found: list[Port] = []
    sides: list[Side] = []
    for name, port in module.ports.items():
        # Seen from inside the module an input gives, to its right.
        side = {"input": Side.RIGHT, "output": Side.LEFT, "inout": Side.BACK}[port.direction]
        found.append(Port(len(found), distinct(name), port.bits, gives=side is not Side.LEFT))
        sides.append(side)
    block = len(found)
    for cell in module.cells.values():
        if cell.type in NOTES:
            continue
        for name, bits in cell.connections.items():
            side = side_of(cell, name)
            found.append(Port(block, distinct(name), bits, gives=side is not Side.LEFT))
            sides.append(side)
        block += 1
    return found, sides


def _hyperedges(
    found: Buses, blocks: Sequence[Block], sides: Sequence[Side], pins: Pins, names: dict[Bit, str]
) -> Iterator[Hyperedge]:
    def attachment(run: Run) -> Attachment:
        flow: Flow = sides[run.port].flow
        block = blocks[found.ports[run.port].block]
        return Attachment(item=block.id, point=_pin(pins, run).id, flow=flow)

    for bus in found.buses:
        source = found.ports[bus.source.port]
        bits = source.bits[bus.source.first : bus.source.last + 1]
        is_clocked = any(
            is_clock(blocks[found.ports[run.port].block].kind, found.ports[run.port].name)
            for run, _ in bus.takers
            if sides[run.port] is Side.LEFT
        )
        first = blocks[source.block]
        # Bits of what a join gives are others' too.
        name = f"{first.id}" if first.kind == "join" else f"{bits[0]}"
        yield Hyperedge(
            id=f"net:{name}" if len(bits) == 1 else f"bus:{name}",
            kind="clock" if is_clocked else "net",
            label=short(_name(found, bus.source, bits, names)),
            radius=radius_of(len(bits)),
            attachments=tuple(attachment(run) for run in (bus.source, *(t for t, _ in bus.takers))),
            data={"nets": [bit for bit in bits if not isinstance(bit, str)]},
        )


def _pin(pins: Pins, run: Run) -> Pin:
    return pins[(run.port, run.first, run.last)]


def _name(found: Buses, run: Run, bits: Sequence[Bit], names: dict[Bit, str]) -> str:
    """What a bus is called: by its net's name, or by that of the port that drives it."""
    if len(bits) == 1:
        return names.get(bits[0], f"net {bits[0]}")
    whole = {names[bit].rpartition("[")[0] if bit in names else "" for bit in bits}
    if len(whole) == 1 and "" not in whole:
        ends = [names[bit].rpartition("[")[2].rstrip("]") for bit in (bits[-1], bits[0])]
        return f"{whole.pop()}[{ends[0]}:{ends[1]}]"
    return f"{found.ports[run.port].name}{ranges(found.ports, {}, run)}"
