from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.api.layout_model import LayoutNumbers
from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.clearance.overlaps import find_overlaps
from app.hyperedges.pinches import find_pinches
from app.hyperedges.routing import Routing
from app.output.clearance_numbers import Verdict
from app.output.numbers import layout_numbers
from app.placement.placement import Placement
from app.program.model import Program
from tests.scene.hand_built import material_of, placed, program_of, scene_of, three_items

CHANCE = np.random.default_rng(5)


def routing_of_three_items() -> Routing:
    """As CURVES would number it: three segments around one join, then one segment."""
    return Routing(
        control_points=CHANCE.normal(size=(4, 4, 3)) * 1e3,
        segment_starts=np.array([0, 3, 4]),
        segment_ends=np.array([[0, 3], [1, 3], [3, 2], [0, 1]]),
        join_positions=CHANCE.normal(size=(1, 3)),
        join_tangents=np.array([[0.6, 0.0, 0.8]]),
        join_starts=np.array([0, 1, 1]),
        join_planes=np.array([2.5, 1 / 3]),
        radii=np.array([0.08, 0.1]),
    )


def numbers(
    program: Program | None = None,
    placement: Placement | None = None,
    routing: Routing | None = None,
    patches: Floats | None = None,
    clearance: float | None = None,
) -> Any:
    program = program or three_items()
    placement = placement or placed(program)
    routing = routing or routing_of_three_items()
    verdict = None
    if clearance is not None:
        verdict = Verdict(certify(routing, placement, clearance), find_pinches(routing))
    overlaps = find_overlaps(placement)
    return json.loads(layout_numbers(program, placement, routing, patches, verdict, overlaps))


def arch(start: float, height: float) -> list[list[float]]:
    """From item to item of the three, whose tops are 2 apart."""
    return [[start, 0, 0.5], [start, 0, height], [start + 2, 0, height], [start + 2, 0, 0.5]]


def two_arches(second_height: float, sharp: bool = False) -> Routing:
    """From x to y, and from y to z past x: both in one plane."""
    curves = np.array([arch(0, 3.0), arch(0, second_height)])
    if sharp:
        curves[0, 1:3] = np.array([[2.0, 0, 9], [0, 0, 9]])
    return Routing(
        control_points=curves,
        segment_starts=np.array([0, 1, 2]),
        segment_ends=np.array([[0, 1], [0, 1]]),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(3, dtype=np.int64),
        join_planes=np.array([3.0, 5.0]),
        radii=np.array([0.08, 0.1]),
    )


def test_items_are_where_they_were_placed() -> None:
    assert numbers()["items"][2] == {
        "id": "z",
        "center": [4, 0, 0],
        "size": [1, 1, 1],
        "rotation": [0, 0, 0, 1],
    }


def test_items_that_overlap_are_named() -> None:
    program = three_items()
    placement = placed(program)
    assert numbers(program, placement)["overlaps"] == []
    nearer = replace(placement, centers=placement.centers * [0.4, 1.0, 1.0])
    assert numbers(program, nearer)["overlaps"] == [
        {"items": ["x", "y"], "depth": pytest.approx(0.2)},
        {"items": ["y", "z"], "depth": pytest.approx(0.2)},
    ]


def test_attachments_name_their_item_and_point() -> None:
    assert numbers()["hyperedges"][1]["attachments"] == [
        {"item": "x", "point": "top", "position": [0, 0, 0.5], "direction": [0, 0, 1]},
        {"item": "y", "point": None, "position": [2, 0, 0.5], "direction": [0, 0, 1]},
    ]


def test_hyperedges_say_which_colour_they_are_drawn_in() -> None:
    program = three_items()
    named = material_of(scene_of(program), "f")
    assert numbers(program)["hyperedges"][1]["color"] == named.removeprefix("plastic ")


def test_segments_say_what_they_join_in_the_order_of_curves() -> None:
    first, second = numbers()["hyperedges"]
    assert [(one["from"], one["to"]) for one in first["segments"]] == [
        ({"attachment": 0}, {"join": 0}),
        ({"attachment": 1}, {"join": 0}),
        ({"join": 0}, {"attachment": 2}),
    ]
    assert [(one["from"], one["to"]) for one in second["segments"]] == [
        ({"attachment": 0}, {"attachment": 1})
    ]


def test_every_number_reads_back_to_the_last_bit() -> None:
    routing = routing_of_three_items()
    first, second = numbers(routing=routing)["hyperedges"]
    read = [one["control_points"] for one in first["segments"] + second["segments"]]
    assert np.array_equal(read, routing.control_points)
    assert [first["join_plane"], second["join_plane"]] == [2.5, 1 / 3]
    assert [first["radius"], second["radius"]] == [0.08, 0.1]
    assert np.array_equal(first["joins"][0]["position"], routing.join_positions[0])
    assert first["joins"][0]["tangent"] == [0.6, 0.0, 0.8]
    assert second["joins"] == []


def test_patches_are_there_when_asked_for() -> None:
    patches = CHANCE.normal(size=(4, 2, 4, 4, 3))
    first, second = numbers(patches=patches)["hyperedges"]
    segments = first["segments"] + second["segments"]
    assert [len(one["patches"]) for one in segments] == [1] * 4
    assert np.array_equal([one["patches"][0]["top"] for one in segments], patches[:, 0])
    assert np.array_equal([one["patches"][0]["bottom"] for one in segments], patches[:, 1])
    assert "patches" not in numbers()["hyperedges"][0]["segments"][0]


@pytest.mark.parametrize("patches", [None, CHANCE.normal(size=(4, 2, 4, 4, 3))])
def test_the_interfaces_description_holds(patches: Floats | None) -> None:
    LayoutNumbers.model_validate(numbers(patches=patches), extra="forbid")


def test_a_program_without_hyperedges_or_items_has_empty_lists() -> None:
    program = program_of(items=[])
    nothing = Routing(
        control_points=np.zeros((0, 4, 3)),
        segment_starts=np.zeros(1, dtype=np.int64),
        segment_ends=np.zeros((0, 2), dtype=np.int64),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(1, dtype=np.int64),
        join_planes=np.zeros(0),
        radii=np.zeros(0),
    )
    assert numbers(program, placed(program), nothing) == {
        "items": [],
        "hyperedges": [],
        "overlaps": [],
        "clearance": None,
    }


def test_without_a_wish_for_clearance_nothing_is_said_about_it() -> None:
    assert numbers()["clearance"] is None


def test_conflicts_name_the_hyperedges_and_the_place() -> None:
    clearance = numbers(routing=two_arches(3.0), clearance=0.05)["clearance"]
    ids = [hyperedge.id for hyperedge in three_items().hyperedges]
    assert clearance["required"] == 0.05
    assert clearance["certified"] is False
    (pair,) = [found for found in clearance["conflicts"] if found["item"] is None]
    assert pair["hyperedges"] == ids
    assert pair["distance"] == pytest.approx(-0.18, abs=1e-3)
    assert len(pair["place"]) == 3
    assert clearance["minimum"] == min(found["distance"] for found in clearance["conflicts"])


def test_a_tube_too_near_to_an_item_names_the_item() -> None:
    routing = two_arches(3.0)
    routing.control_points[1] = np.array([[0, 0, 0.5], [1, 0, 3.5], [4, 0, 3.5], [4, 0, 0]])
    found = numbers(routing=routing, clearance=0.05)["clearance"]["conflicts"]
    assert [(one["hyperedges"], one["item"]) for one in found if one["item"]] == [(["f"], "z")]


def test_a_pinch_names_its_segment() -> None:
    clearance = numbers(routing=two_arches(5.0, sharp=True), clearance=0.0)["clearance"]
    assert [found["segment"] for found in clearance["pinches"]] == [0]
    assert clearance["pinches"][0]["radius_of_curvature"] < 1.5 * 0.08


def test_the_interfaces_description_holds_for_conflicts_as_well() -> None:
    LayoutNumbers.model_validate(numbers(routing=two_arches(3.0), clearance=0.05))
