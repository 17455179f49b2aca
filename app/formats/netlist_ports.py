"""What ports of a netlist do, and what its nets are called."""

from __future__ import annotations

from app.formats.netlist import Bit, Cell, Module, bit_names
from app.formats.netlist_layout import Side

GIVING_PORTS = ("Y", "Q", "O", "OUT", "CO", "X")
"""Ports that most likely give, where a netlist does not say."""

CLOCK_PORTS = ("CLK", "CK", "CLOCK")

NOTES = ("$scopeinfo",)
"""Types of cells that carry remarks about the source and join nothing."""


def is_clock(kind: str, port: str) -> bool:
    """Whether a port that takes, on a cell of a kind, is for a clock."""
    return port.upper() in CLOCK_PORTS or (port.upper() == "C" and kind == "flipflop")


def side_of(cell: Cell, port: str) -> Side:
    """On which side a port of a cell is, by its direction."""
    direction = cell.port_directions.get(port)
    if direction is None:
        return Side.RIGHT if port.upper() in GIVING_PORTS else Side.LEFT
    return {"input": Side.LEFT, "output": Side.RIGHT, "inout": Side.BACK}[direction]


def net_names(module: Module) -> dict[Bit, str]:
    """The best name of each net: a visible one before a hidden one, then the shortest."""
    best: dict[Bit, tuple[bool, int, str]] = {}
    for name, net in module.netnames.items():
        names = bit_names(name, len(net.bits), net.offset, net.upto)
        for full, bit in zip(names, net.bits, strict=True):
            rank = (bool(net.hide_name), len(full), full)
            best[bit] = min(best.get(bit, rank), rank)
    return {bit: rank[2] for bit, rank in best.items()}
