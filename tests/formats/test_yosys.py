import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from app.errors import DocumentError
from app.formats.yosys import read
from app.program.model import Item, Program
from app.program.shapes import Box
from app.settings import Settings

FOLDER = Path(__file__).parents[2] / "examples" / "yosys"


def example(name: str) -> Program:
    return read((FOLDER / f"{name}.json").read_bytes(), Settings())


def netlist(**modules: Any) -> Program:
    return read(json.dumps({"modules": modules}).encode(), Settings())


def pins_of(name: str, module: str) -> Counter[int | str]:
    """How many pins each bit has, counted from the netlist itself."""
    section = json.loads((FOLDER / f"{name}.json").read_text())["modules"][module]
    bits = [port["bits"] for port in section["ports"].values()]
    bits += [bits for cell in section["cells"].values() for bits in cell["connections"].values()]
    return Counter(bit for group in bits for bit in group)


def test_up3down5_keeps_23_nets_of_three_or_more_pins_whole() -> None:
    program = example("up3down5")
    large = [edge for edge in program.hyperedges if len(edge.attachments) >= 3]
    assert len(large) == 23


@pytest.mark.parametrize("name", ["up3down5", "mux4", "hyperedges"])
def test_every_net_has_all_its_pins_in_one_hyperedge(name: str) -> None:
    program = example(name)
    nets = {edge.id: len(edge.attachments) for edge in program.hyperedges}
    for bit, count in pins_of(name, program.name or "").items():
        if isinstance(bit, int):
            assert nets.get(f"net:{bit}", 1) == count
        else:
            assert nets[f"constant:{bit}"] == count + 1


def _box(item: Item) -> tuple[float, float, float, float]:
    assert item.position is not None
    assert isinstance(item.shape, Box)
    assert item.shape.size is not None
    (x, y, _), (width, depth, _) = item.position, item.shape.size
    return (x - width / 2, x + width / 2, y - depth / 2, y + depth / 2)


@pytest.mark.parametrize("name", ["up3down5", "mux4", "hyperedges"])
def test_items_do_not_overlap(name: str) -> None:
    boxes = [_box(item) for item in example(name).items]
    for number, (left, right, near, far) in enumerate(boxes):
        for other in boxes[:number]:
            assert left >= other[1] or right <= other[0] or near >= other[3] or far <= other[2]


def test_inputs_stand_left_of_what_they_drive_and_outputs_right() -> None:
    program = example("mux4")
    at = {item.id: item.position[0] for item in program.items if item.position}
    cells = [x for name, x in at.items() if name.startswith("cell:")]
    assert max(x for name, x in at.items() if name in ("port:I0", "port:S0")) < min(cells)
    assert at["port:O"] > max(cells)


def test_the_top_module_is_shown() -> None:
    port = {"a": {"direction": "input", "bits": [2]}, "b": {"direction": "output", "bits": [2]}}
    inner = {"ports": port}
    outer = {"ports": port, "cells": {"u": {"type": "inner", "connections": {"a": [2]}}}}
    assert netlist(inner=inner, outer=outer).name == "outer"
    assert netlist(inner=inner | {"attributes": {"top": 1}}, outer=outer).name == "inner"


def test_names_of_nets_are_the_visible_ones() -> None:
    labels = {edge.label for edge in example("up3down5").hyperedges}
    assert "clock" in labels
    assert "data_in[0]" in labels


def test_a_clock_net_is_of_its_own_kind() -> None:
    assert {edge.label for edge in example("up3down5").hyperedges if edge.kind == "clock"} == {
        "clock"
    }


@pytest.mark.parametrize(
    ("document", "place"),
    [
        ({}, "/modules"),
        ({"modules": {}}, "/modules"),
        ({"modules": {"m": {}}}, "/modules"),
        ({"modules": {"m": {"ports": {"a": {"bits": [1]}}}}}, "/modules/m/ports/a/direction"),
        (
            {"modules": {"m": {"ports": {"a": {"direction": "up", "bits": [1]}}}}},
            "/modules/m/ports/a/direction",
        ),
        (
            {"modules": {"m": {"cells": {"c": {"type": "t", "connections": {"": [2]}}}}}},
            "/modules/m/cells/c/connections/",
        ),
        (
            {"modules": {"m": {"cells": {"a/b": {"type": "t", "connections": {"A": ["2"]}}}}}},
            "/modules/m/cells/a~1b/connections/A/0",
        ),
    ],
)
def test_faults_point_into_the_netlist(document: Any, place: str) -> None:
    with pytest.raises(DocumentError) as raised:
        read(json.dumps(document).encode(), Settings())
    assert {fault.pointer for fault in raised.value.faults} == {place}


def test_a_net_may_be_numbered_by_a_float_that_is_whole() -> None:
    cell = {"type": "t", "connections": {"A": [2.0], "B": [2]}}
    program = read(json.dumps({"modules": {"m": {"cells": {"c": cell}}}}).encode(), Settings())
    assert [hyperedge.id for hyperedge in program.hyperedges] == ["net:2"]


def test_a_netlist_that_is_too_large_is_refused() -> None:
    ports = {f"p{n}": {"direction": "input", "bits": [n]} for n in range(50)}
    with pytest.raises(DocumentError):
        read(json.dumps({"modules": {"m": {"ports": ports}}}).encode(), Settings(max_items=10))


def test_a_ring_of_cells_is_cut_somewhere() -> None:
    cells = {
        f"c{n}": {
            "type": "$not",
            "port_directions": {"A": "input", "Y": "output"},
            "connections": {"A": [n], "Y": [(n + 1) % 5]},
        }
        for n in range(5)
    }
    program = netlist(m={"cells": cells})
    assert len(program.hyperedges) == 5
    assert len({item.position for item in program.items}) == 5
