"""Random netlists as Yosys writes them: registers, gates and operators, with slices of buses."""

from __future__ import annotations

import random
from typing import Any

BINARY = ("$add", "$sub", "$and", "$or", "$xor")
COMPARING = ("$eq", "$lt", "$logic_and")
MULTIPLEXING = "$mux"
STORING = "$dff"
WIDTHS = (1, 1, 2, 4, 8)


class _Module:
    """A module that grows: signals that can be taken, and cells that give more of them."""

    def __init__(self, dice: random.Random) -> None:
        self.dice = dice
        self.bits = 2
        self.signals: list[list[int]] = []
        self.cells: dict[str, Any] = {}
        self.ports: dict[str, Any] = {}

    def new(self, width: int) -> list[int]:
        """Bits that nobody has."""
        self.bits += width
        return list(range(self.bits - width, self.bits))

    def taken(self, width: int) -> list[int | str]:
        """Bits of what there is: a slice, two together, one again and again, or a constant."""
        kind = self.dice.random()
        if kind < 0.08:
            return [self.dice.choice("01") for _ in range(width)]
        signal = self.dice.choice(self.signals)
        if len(signal) >= width:
            first = self.dice.choice([0, 0, self.dice.randrange(len(signal) - width + 1)])
            return list(signal[first : first + width])
        rest = width - len(signal)
        if kind < 0.4:
            return [*signal, *([signal[-1]] * rest)]
        return [*signal, *self.taken(rest)]

    def cell(self, kind: str, gives: dict[str, list[int]], **takes: list[int | str]) -> None:
        """Add a cell."""
        directions = dict.fromkeys(takes, "input") | dict.fromkeys(gives, "output")
        self.cells[f"{kind}${len(self.cells)}"] = {
            "type": kind,
            "port_directions": directions,
            "connections": takes | gives,
        }


def random_netlist(seed: int, cells: int = 24) -> dict[str, Any]:
    """A netlist of one module with so many ``cells``: the same for the same ``seed``."""
    dice = random.Random(seed)
    module = _Module(dice)
    clock = module.new(1)
    module.ports["clk"] = {"direction": "input", "bits": clock}
    for number in range(dice.randint(2, 5)):
        bits = module.new(dice.choice(WIDTHS))
        module.ports[f"in{number}"] = {"direction": "input", "bits": bits}
        module.signals.append(bits)
    registers = [module.new(dice.choice(WIDTHS)) for _ in range(cells // 6)]
    module.signals.extend(registers)
    for _ in range(cells - len(registers)):
        width = dice.choice(WIDTHS)
        kind = dice.choice((*BINARY, *COMPARING, MULTIPLEXING))
        result = module.new(1 if kind in COMPARING else width)
        one, other = module.taken(width), module.taken(width)
        if kind == MULTIPLEXING:
            module.cell(kind, {"Y": result}, A=one, B=other, S=module.taken(1))
        else:
            module.cell(kind, {"Y": result}, A=one, B=other)
        module.signals.append(result)
    for register in registers:
        module.cell(STORING, {"Q": register}, CLK=list(clock), D=module.taken(len(register)))
    for number in range(dice.randint(1, 4)):
        taken = module.taken(dice.choice(WIDTHS))
        module.ports[f"out{number}"] = {"direction": "output", "bits": taken}
    return {"modules": {"top": {"ports": module.ports, "cells": module.cells}}}
