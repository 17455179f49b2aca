"""Programs of all kinds in layers, laid out and proven as a user's are."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from app.formats import registry
from app.hyperedges.clearance.overlaps import find_overlaps
from app.layout import Layout, judge, lay_out
from app.layout_record import read_layout, write_layout
from app.notations.loader import load_notation
from app.placement.place import place
from app.program.reading import read_program
from app.settings import Settings
from benchmarks.random_netlists import random_netlist

LAYERS = {"placement": "layers"}
SAID = {"layout": LAYERS}


def laid(document: dict[str, Any]) -> Layout:
    return lay_out(read_program(json.dumps(document).encode(), Settings()))


def netlist(document: dict[str, Any]) -> Layout:
    data = json.dumps(document).encode()
    return lay_out(registry.read("yosys", data, Settings(), tuple(LAYERS.items())))


def assert_clear(layout: Layout) -> None:
    verdict = judge(layout)
    assert verdict is not None
    assert verdict.certificate.certified
    assert not len(verdict.pinches.segments)
    assert not len(verdict.certificate.own.hyperedges)


@pytest.mark.parametrize("seed", range(6))
def test_random_netlists_are_clear(seed: int) -> None:
    layout = netlist(random_netlist(seed, 12 + 6 * seed))
    assert layout.placement.layers is not None
    assert_clear(layout)


def test_long_chains_with_nets_along_and_back_are_clear_where_they_are_folded() -> None:
    names = [f"n{number}" for number in range(60)]
    edges = [
        edge(f"e{number}", (names[number], "out"), (names[number + 1], "in"))
        for number in range(59)
    ]
    edges.append(edge("all", (names[0], "out"), *((name, "in") for name in names[1:])))
    edges.append(edge("back", (names[59], "out"), (names[0], "in")))
    layout = laid({"items": [{"id": name} for name in names], "hyperedges": edges, **SAID})
    assert layout.placement.layers is not None
    assert len(layout.placement.layers.plans[0].turning) >= 6
    assert_clear(layout)


def test_the_same_netlist_has_the_same_curves() -> None:
    one, other = (netlist(random_netlist(3)).routing.control_points for _ in range(2))
    assert one.tobytes() == other.tobytes()


def edge(name: str, *ends: tuple[str, str]) -> dict[str, Any]:
    return {"id": name, "attachments": [{"item": item, "flow": flow} for item, flow in ends]}


NODES: dict[str, Any] = {
    "items": [{"id": name, "label": name} for name in ("read", "parse", "check", "log", "write")],
    "hyperedges": [
        edge("a", ("read", "out"), ("parse", "in")),
        edge("b", ("parse", "out"), ("check", "in"), ("log", "in")),
        edge("c", ("check", "out"), ("write", "in")),
        edge("d", ("read", "out"), ("write", "in")),
        edge("e", ("check", "out"), ("parse", "in")),
    ],
    "layout": LAYERS,
}


def test_a_directed_program_runs_from_left_to_right_upright() -> None:
    layout = laid(NODES)
    x, y, z = layout.placement.centers.T
    assert x[0] < x[1] < x[2] < x[4]
    assert (y == 0.0).all()
    assert len(set(z.tolist())) > 1
    assert_clear(layout)
    # Ends are on the sides that flow says, and every curve is level there.
    assert (np.abs(layout.placement.attachment_directions[:, 0]) == 1.0).all()
    assert layout.placement.attachment_directions[0, 0] == 1.0
    assert layout.placement.attachment_directions[1, 0] == -1.0


def test_items_are_high_enough_for_their_ends() -> None:
    items = [{"id": "hub", "label": "hub"}, *({"id": f"n{number}"} for number in range(7))]
    edges = [edge(f"e{number}", (f"n{number}", "out"), ("hub", "in")) for number in range(7)]
    layout = laid({"items": items, "hyperedges": edges, "layout": LAYERS})
    assert layout.placement.sizes[0, 2] >= 6 * 0.6
    assert_clear(layout)


def test_items_with_positions_stay_and_the_others_stand_beside_them() -> None:
    items = [{**NODES["items"][0], "position": [1.0, 2.0, 3.0]}, *NODES["items"][1:]]
    layout = laid({**NODES, "items": items})
    assert layout.placement.centers[0].tolist() == [1.0, 2.0, 3.0]
    assert (layout.placement.centers[1:, 0] > 1.5).all()
    assert not len(find_overlaps(layout.placement).items)


def test_what_stands_in_a_tray_moves_with_it() -> None:
    items = [
        {"id": "tray"},
        {"id": "one", "parent": "tray", "label": "one"},
        {"id": "two", "parent": "tray", "label": "two"},
        {"id": "three", "label": "three"},
    ]
    edges = [edge("a", ("one", "out"), ("three", "in")), edge("b", ("one", "out"), ("two", "in"))]
    layout = laid({"items": items, "hyperedges": edges, "layout": LAYERS})
    assert layout.placement.layers is None
    tray, one = layout.placement.centers[0], layout.placement.centers[1]
    assert (np.abs(one - tray)[:2] < layout.placement.sizes[0, :2] / 2).all()
    assert layout.placement.centers[3, 0] > tray[0]


@pytest.mark.parametrize("items", [[], [{"id": "a"}], [{"id": "a"}, {"id": "b", "label": "b"}]])
def test_items_without_hyperedges_have_places(items: list[dict[str, str]]) -> None:
    layout = laid({"items": items, "layout": LAYERS})
    assert len(layout.placement.centers) == len(items)
    assert np.isfinite(layout.placement.centers).all()


def test_an_edit_keeps_layers_where_they_are() -> None:
    before = laid(NODES)
    document = {**NODES, "items": [*NODES["items"], {"id": "new", "label": "new"}]}
    after = lay_out(read_program(json.dumps(document).encode(), Settings()), previous=before)
    assert after.placement.centers[:-1].tobytes() == before.placement.centers.tobytes()
    assert after.routing.control_points.tobytes() == before.routing.control_points.tobytes()


def test_hyperedges_that_end_at_one_point_are_side_by_side_there() -> None:
    point = {"id": "out", "position": [0.7, 0.0, 0.0], "direction": [1.0, 0.0, 0.0]}
    shape = {"type": "box", "size": [1.4, 0.8, 1.2]}
    items = [
        {"id": "hub", "label": "hub", "shape": shape, "attachment_points": [point]},
        *({"id": f"n{number}", "label": f"n{number}"} for number in range(3)),
    ]
    edges = [
        {
            "id": f"e{number}",
            "attachments": [
                {"item": "hub", "point": "out", "flow": "out"},
                {"item": f"n{number}", "flow": "in"},
            ],
        }
        for number in range(3)
    ]
    layout = laid({"items": items, "hyperedges": edges, **SAID})
    assert layout.placement.layers is None
    assert len({tuple(end) for end in layout.placement.attachment_positions[::2].tolist()}) == 3
    assert_clear(layout)


def test_what_is_too_much_for_layers_stands_in_rows() -> None:
    names = [f"n{number}" for number in range(280)]
    pairs = [*pairwise(names), *([(names[0], names[-1])] * 280)]
    edges = [
        edge(f"e{number}", (one, "out"), (other, "in")) for number, (one, other) in enumerate(pairs)
    ]
    document = {"items": [{"id": name} for name in names], "hyperedges": edges, **SAID}
    program = read_program(json.dumps(document).encode(), Settings())
    placement = place(program, load_notation(program.notation))
    assert placement.layers is None
    assert (placement.centers[:, 2] == placement.centers[0, 2]).all()


@pytest.mark.parametrize("netlists", [False, True])
def test_layers_are_recorded_as_they_are(*, netlists: bool) -> None:
    layout = netlist(random_netlist(1)) if netlists else laid(NODES)
    read = read_layout(layout.program, write_layout(layout))
    assert read is not None
    for name in ("centers", "sizes", "attachment_positions"):
        one, other = (getattr(each.placement, name) for each in (layout, read))
        assert one.tobytes() == other.tobytes()
    assert layout.placement.solids == read.placement.solids
    assert layout.routing.control_points.tobytes() == read.routing.control_points.tobytes()
