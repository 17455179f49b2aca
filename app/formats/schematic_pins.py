"""Where buses and constants meet the blocks of a schematic, and what is written there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.formats.buses import Buses, Constant, Port, Run
from app.formats.names import short, untaken

LATE = ("S", "SEL", "C", "CLK", "CK", "CLOCK", "EN", "E", "R", "ARST", "SRST", "RST")
"""Ports that stand below the others: they say when or which, not what."""

LONGEST_VALUE = 6
"""Bits of a constant that are written one by one: longer ones are hexadecimal."""


@dataclass(frozen=True, slots=True)
class Pin:
    """Where a bus of so many ``bits``, or a constant, meets a block: on its left (-1) or right (1).

    ``note`` is written above the tube, ``constant`` instead of it.
    """

    id: str
    port: str
    run: Run
    side: int
    note: str
    bits: int
    constant: str | None = None


Pins = Mapping[tuple[int, int, int], Pin]
"""Pins by the port and the first and last place of their runs."""


def ranges(ports: Sequence[Port], numbering: Mapping[int, tuple[int, int]], run: Run) -> str:
    """The bits of a run as their source numbers them; ``numbering``: offset and upto of ports.

    >>> ranges([Port(0, "A", (2, 3, 4), False)], {}, Run(0, 1, 2))
    '[2:1]'
    """
    offset, upto = numbering.get(run.port, (0, 0))
    width = len(ports[run.port].bits)
    high, low = (offset + (width - 1 - place if upto else place) for place in (run.last, run.first))
    return f"[{high}:{low}]" if run.last > run.first else f"[{high}]"


def pins_of(found: Buses, numbering: Mapping[int, tuple[int, int]]) -> tuple[Pins, list[list[Pin]]]:
    """All pins, and those of each block, from the top down."""
    ports = found.ports
    blocks = 1 + max((port.block for port in ports), default=-1)
    pins: dict[tuple[int, int, int], Pin] = {}
    of_block: list[list[Pin]] = [[] for _ in range(blocks)]
    taken: list[set[str]] = [set() for _ in range(blocks)]
    for port in ports:
        taken[port.block].add(port.name)
    joins = set(found.joins)

    def add(run: Run, part: str, width: int, constant: str | None = None) -> None:
        port = ports[run.port]
        bits = ranges(ports, numbering, run)
        is_whole = run.width == len(port.bits)
        name = port.name if is_whole else untaken(f"{port.name}{bits}", taken[port.block])
        note = bits if not is_whole or port.block in joins else part
        pin = Pin(name, port.name, run, 1 if port.gives else -1, note, width, constant)
        pins[(run.port, run.first, run.last)] = pin
        of_block[port.block].append(pin)

    for bus in found.buses:
        width = bus.source.width
        add(bus.source, f"/{width}" if width > 1 else "", width)
        for run, part in bus.takers:
            is_part = part.width != width
            add(run, ranges(ports, numbering, part) if is_part else "", width)
    for constant in found.constants:
        add(constant.run, "", 0, _value(constant))
    for group in of_block:
        group.sort(key=lambda pin: (pin.port.upper() in LATE, pin.run.port, -pin.run.last))
    return pins, of_block


def _value(constant: Constant) -> str:
    """What is written for a constant.

    >>> _value(Constant(Run(0, 0, 7), "00010011"))
    '0x13'
    """
    values = constant.values
    if len(set(values)) == 1 and len(values) > 2:
        return f"{len(values)}×{values[0]}"
    if len(values) <= LONGEST_VALUE or set(values) - {"0", "1"}:
        return short(values, 20)
    return short(f"0x{int(values, 2):x}", 20)
