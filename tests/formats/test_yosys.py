import contextlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import DocumentError, DocumentTooLarge, InvalidDocument
from app.formats.netlist_layout import Block, Pin, Side
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
        ({"modules": {"m": {}}}, "/modules/m"),
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


@pytest.mark.parametrize(
    ("limit", "what"),
    [({"max_items": 49}, "50 ports and cells"), ({"max_attachments": 149}, "150 pins")],
)
def test_a_netlist_that_is_too_large_is_refused(limit: dict[str, int], what: str) -> None:
    ports = {f"p{n}": {"direction": "input", "bits": [n, n, n]} for n in range(50)}
    with pytest.raises(DocumentTooLarge, match=f"/modules/m: {what}"):
        read(
            json.dumps({"modules": {"m": {"ports": ports}}}).encode(),
            Settings.model_validate(limit),
        )


def test_all_faults_of_a_netlist_come_at_once() -> None:
    port = {"direction": "in", "bits": [2, "y", -1, 2.5, True, 2**60]}
    with pytest.raises(InvalidDocument) as raised:
        netlist(m={"ports": {"p": port}, "cells": {"c": {"connections": []}}})
    found = {fault.pointer: fault.detail for fault in raised.value.faults}
    assert set(found) == {
        "/modules/m/ports/p/direction",
        *(f"/modules/m/ports/p/bits/{place}" for place in (1, 2, 3, 4, 5)),
        "/modules/m/cells/c/type",
        "/modules/m/cells/c/connections",
    }
    assert found["/modules/m/ports/p/bits/1"] == (
        "Must be a whole number or '0', '1', 'x' or 'z', not \"y\"."
    )


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.sampled_from(("0", "x", "input")),
    lambda inner: st.lists(inner) | st.dictionaries(st.sampled_from(("bits", "type", "A")), inner),
    max_leaves=10,
)
bits = st.lists(st.integers(0, 4) | st.sampled_from(("0", "1", "x", "z")), max_size=4)
names = st.sampled_from(("A", "A[0]", "A[1]", "B", "CLK", "Y", "x" * 300))
directions = st.sampled_from(("input", "output", "inout"))
modules = st.fixed_dictionaries(
    {
        "ports": st.dictionaries(
            names, st.fixed_dictionaries({"direction": directions, "bits": bits}), max_size=3
        ),
        "cells": st.dictionaries(
            names,
            st.fixed_dictionaries(
                {
                    "type": st.sampled_from(("$dff", "$add", "cpu")),
                    "connections": st.dictionaries(names, bits, max_size=3),
                    "port_directions": st.dictionaries(names, directions, max_size=3),
                }
            ),
            max_size=4,
        ),
    }
)


@given(json_values, st.sampled_from(("ports", "cells", "netnames", "attributes")))
def test_any_json_value_is_a_netlist_or_a_document_error(value: Any, section: str) -> None:
    with contextlib.suppress(DocumentError):
        netlist(m={section: value})
    with contextlib.suppress(DocumentError):
        netlist(m={section: {"n": value}, "cells": {"c": {"type": "t", "connections": {}}}})


@given(modules)
def test_every_pin_of_a_net_that_joins_is_an_attachment_once(module: dict[str, Any]) -> None:
    widths = [port["bits"] for port in module["ports"].values()]
    widths += [b for cell in module["cells"].values() for b in cell["connections"].values()]
    pins = Counter(bit for group in widths for bit in group)
    if not module["ports"] and not module["cells"]:
        return
    program = netlist(m=module)
    assert {edge.id: len(edge.attachments) for edge in program.hyperedges} == {
        **{f"net:{bit}": n for bit, n in pins.items() if isinstance(bit, int) and n > 1},
        **{f"constant:{bit}": n + 1 for bit, n in pins.items() if isinstance(bit, str)},
    }
    points = [(item.id, point.id) for item in program.items for point in item.attachment_points]
    assert len(points) == len(set(points)) == pins.total() + sum(isinstance(b, str) for b in pins)


def test_a_port_named_like_a_bit_of_another_keeps_its_name() -> None:
    cell = {"type": "t", "connections": {"A": [1, 3], "A[0]": [2]}}
    (item,) = netlist(m={"cells": {"c": cell}}).items
    assert [point.id for point in item.attachment_points] == ["A[0]'", "A[1]", "A[0]"]


def test_long_names_are_shortened_and_stay_apart() -> None:
    cell = {"type": "$and", "connections": {"A": [1], "Y": [2]}}
    program = netlist(m={"cells": {"x" * 300 + end: cell for end in "ab"}})
    ids = [item.id for item in program.items]
    assert len(set(ids)) == 2
    assert all(len(name) <= 200 for name in ids)
    assert [item.data["cell"] for item in program.items] == ["x" * 300 + "a", "x" * 300 + "b"]


def test_bits_are_numbered_as_in_the_source() -> None:
    port = {"direction": "input", "bits": [2, 3], "offset": 4}
    upto = {"direction": "input", "bits": [2, 3], "upto": 1}
    program = netlist(m={"ports": {"a": port, "b": upto}, "netnames": {"w": port}})
    assert [p.id for item in program.items for p in item.attachment_points] == [
        "a[4]", "a[5]", "b[1]", "b[0]",
    ]  # fmt: skip
    assert [edge.label for edge in program.hyperedges] == ["w[4]", "w[5]"]


def test_a_cell_takes_on_the_left_gives_on_the_right_and_does_both_at_the_back() -> None:
    cell = {
        "type": "pad",
        "port_directions": {"i": "input", "o": "output", "pin": "inout"},
        "connections": {"i": [1], "o": [2], "pin": [3, 4]},
    }
    (item,) = netlist(m={"cells": {"c": cell}}).items
    left, right, back, beside = item.attachment_points
    assert left.position[0] == -right.position[0] < 0
    assert left.direction[0] == -right.direction[0] < 0
    assert back.position[1] == beside.position[1] > 0
    assert beside.position[0] - back.position[0] == pytest.approx(0.36)


def test_where_directions_are_not_said_names_tell_them() -> None:
    (item,) = netlist(m={"cells": {"c": {"type": "t", "connections": {"A": [1], "Y": [2]}}}}).items
    assert {point.id: point.position[0] > 0 for point in item.attachment_points} == {
        "A": False, "Y": True,
    }  # fmt: skip


def test_module_ports_alone_are_joined_output_to_input() -> None:
    program = example("hyperedges")
    assert {edge.id: [end.item for end in edge.attachments] for edge in program.hyperedges} == {
        "net:2": ["port:i0", "port:i1", "port:i4"],
        "net:3": ["port:i2", "port:i3", "port:o0"],
        "net:4": ["port:o1", "port:o2", "port:o3"],
    }
    at = {item.id: item.position[0] for item in program.items if item.position}
    assert at["port:i2"] + 2 < at["port:o0"]


def test_between_columns_there_is_air() -> None:
    boxes = sorted(_box(item)[:2] for item in example("up3down5").items)
    right = boxes[0][1]
    for left, its_right in boxes:
        assert left < right or left - right >= 2
        right = max(right, its_right)


def test_points_sit_on_the_sides_of_their_boxes() -> None:
    for item in example("up3down5").items:
        assert isinstance(item.shape, Box)
        assert item.shape.size is not None
        width, depth, height = item.shape.size
        for point in item.attachment_points:
            x, y, z = point.position
            assert abs(x) == width / 2
            assert abs(y) < depth / 2
            assert abs(z) < height / 2


def test_a_constant_stands_just_before_what_it_feeds() -> None:
    cells = {
        f"c{n}": {
            "type": "$not",
            "port_directions": {"A": "input", "B": "input", "Y": "output"},
            "connections": {"A": [n], "Y": [n + 1], **({"B": ["1"]} if n == 4 else {})},
        }
        for n in range(2, 6)
    }
    at = {item.id: item.position[0] for item in netlist(m={"cells": cells}).items if item.position}
    assert at["cell:c2"] < at["constant:1"] < at["cell:c4"]
    assert at["constant:1"] == pytest.approx(at["cell:c3"])


def test_remarks_about_the_source_and_black_boxes_are_not_shown() -> None:
    cell = {"type": "$and", "connections": {"A": [1], "Y": [2]}}
    note = {"type": "$scopeinfo", "connections": {}}
    port = {"a": {"direction": "input", "bits": [2]}}
    program = netlist(
        library={"ports": port, "attributes": {"blackbox": 1}},
        empty={"ports": port},
        design={"cells": {"c": cell, "note": note}},
    )
    assert program.name == "design"
    assert [item.id for item in program.items] == ["cell:c"]


def test_a_block_with_very_many_pins_still_fits_into_a_document() -> None:
    pin = Pin("A", "A", 2, Side.LEFT)
    assert max(Block("b", "cell", "b", (pin,) * 400_000).size) < 100_000


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


def test_attachments_flow_as_the_ports_say() -> None:
    program = netlist(
        top={
            "ports": {"a": {"direction": "input", "bits": [2]}},
            "cells": {
                "pad": {
                    "type": "pad",
                    "port_directions": {"A": "input", "P": "inout", "Q": "output"},
                    "connections": {"A": [2], "P": [3], "Q": [4]},
                },
                "sink": {
                    "type": "sink",
                    "port_directions": {"P": "input", "Q": "input"},
                    "connections": {"P": [3], "Q": [4]},
                },
            },
        }
    )
    flows = {
        (end.item, end.point): end.flow for edge in program.hyperedges for end in edge.attachments
    }
    assert flows == {
        ("port:a", "a"): "out",
        ("cell:pad", "A"): "in",
        ("cell:pad", "P"): "both",
        ("cell:sink", "P"): "in",
        ("cell:pad", "Q"): "out",
        ("cell:sink", "Q"): "in",
    }
