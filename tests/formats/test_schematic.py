from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from app.formats import registry
from app.program.model import Program
from app.settings import Settings
from benchmarks.random_netlists import random_netlist

FOLDER = Path(__file__).parents[2] / "examples" / "yosys"
LAYERS = ("placement", "layers")


def schematic(data: bytes | dict[str, Any], *wishes: tuple[str, object]) -> Program:
    text = data if isinstance(data, bytes) else json.dumps(data).encode()
    return registry.read("yosys", text, Settings(), (LAYERS, *wishes))


def example(name: str) -> Program:
    return schematic((FOLDER / f"{name}.json").read_bytes())


def test_buses_of_up3down5_are_one_hyperedge_each_and_know_their_nets() -> None:
    program = example("up3down5")
    edges = {edge.id: edge for edge in program.hyperedges}
    assert len(edges) == 20
    count = next(edge for edge in program.hyperedges if edge.label == "count_out[8:0]")
    assert len(count.data["nets"]) == 9  # type: ignore[arg-type]
    assert count.radius is not None
    assert count.radius > edges["net:2"].radius  # type: ignore[operator]
    assert [end.flow for end in count.attachments] == ["out", *["in"] * 4]


@pytest.mark.parametrize("wishes", [(), (("bundles", "none"),)])
@pytest.mark.parametrize("seed", range(5))
def test_every_bit_is_joined_to_all_its_pins(seed: int, wishes: tuple[Any, ...]) -> None:
    """Followed through hyperedges and joins, the bits are joined as in the netlist."""
    document = random_netlist(seed)
    module = document["modules"]["top"]
    ports = [(f"port:{name}", "", port["bits"]) for name, port in module["ports"].items()]
    ports += [
        (f"cell:{name}", port, bits)
        for name, cell in module["cells"].items()
        for port, bits in cell["connections"].items()
    ]
    pins: dict[int, Counter[str]] = {}
    for item, _, bits in ports:
        for bit in bits:
            if isinstance(bit, int):
                pins.setdefault(bit, Counter())[item] += 1
    wanted = {bit: set(items) for bit, items in pins.items() if items.total() > 1}
    program = schematic(document, *wishes)
    found: dict[int, set[str]] = {}
    for edge in program.hyperedges:
        nets = [net for net in edge.data["nets"] if isinstance(net, int)]  # type: ignore[union-attr]
        ends = {end.item for end in edge.attachments if not end.item.startswith("join:")}
        for net in nets:
            found.setdefault(net, set()).update(ends)
    for bit, items in wanted.items():
        assert items <= found[bit]


def test_constants_are_written_at_their_pins() -> None:
    program = example("up3down5")
    written = [item.label for item in program.items if item.kind == "value"]
    assert sorted(filter(None, written)) == ["00", "01", "10", "101", "11"]
    assert not any(edge.id.startswith("constant") for edge in program.hyperedges)


def test_letters_belong_to_their_items() -> None:
    program = example("mux4")
    parents = {item.id for item in program.items if item.parent is None}
    letters = [item for item in program.items if item.parent is not None]
    assert letters
    assert {item.parent for item in letters} <= parents
    assert {item.kind for item in letters} <= {"caption", "port", "range", "value"}


@pytest.mark.parametrize("form", ["not", "nand", "nor", "xnor", "xor", "or", "and", "buf", "mux"])
def test_each_gate_has_a_body(form: str) -> None:
    takes = {"A": [2], "S": [3], "B": [4]} if form == "mux" else {"A": [2], "B": [3]}
    cell = {
        "type": f"${form}",
        "port_directions": dict.fromkeys(takes, "input") | {"Y": "output"},
        "connections": takes | {"Y": [5]},
    }
    other = {"type": "t", "port_directions": {"A": "input"}, "connections": {"A": [5]}}
    document = {"modules": {"top": {"cells": {"gate": cell, "other": other}}}}
    gate = schematic(document).items[0]
    assert gate.shape is not None
    assert gate.shape.type == "csg"
