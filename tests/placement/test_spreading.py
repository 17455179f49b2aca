"""Hyperedges that would end at one place get places of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.arrays import Floats
from app.layout import lay_out
from app.layout_record import read_layout, write_layout
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.slots import default_slots
from app.placement.standing import Standing
from app.program.model import Program
from app.solids.extents import size_of
from app.solids.solid import Arrow, Box, Cone, Cylinder, Solid, Sphere, Text, Tray

APART = 2 * 0.08 + 0.05


def star(hyperedges: int, **parts: Any) -> dict[str, Any]:
    """A hub that so many others are joined to, each by a hyperedge of its own."""
    others = [f"n{number}" for number in range(hyperedges)]
    return {
        "items": [{"id": "hub", **parts}, *({"id": name} for name in others)],
        "hyperedges": [
            {"id": name, "attachments": [{"item": "hub"}, {"item": name}]} for name in others
        ],
    }


def placed(document: dict[str, Any]) -> tuple[Program, Placement]:
    program = Program.model_validate(document)
    return program, place(program, load_notation(program.notation))


def ends_at(placement: Placement, item: int) -> Floats:
    found: Floats = placement.attachment_positions[placement.attachment_items == item]
    return found


def least_distance(places: Floats) -> float:
    ways = np.linalg.norm(places[:, None] - places[None], axis=2)
    return float((ways + np.where(np.eye(len(places)), np.inf, 0.0)).min())


@pytest.mark.parametrize(
    "shape",
    [
        {"type": "box", "size": [2, 1, 1]},
        {"type": "sphere", "radius": 1},
        {"type": "cylinder", "radius": 1, "height": 1},
        {"type": "cone", "radius": 1, "height": 1},
        {"type": "tray", "size": [4, 3, 1]},
        {"type": "arrow", "length": 6, "radius": 0.5},
    ],
)
@pytest.mark.parametrize("count", [2, 6])
def test_ends_without_a_point_are_far_enough_apart(shape: dict[str, Any], count: int) -> None:
    _, placement = placed(star(count, shape=shape))
    assert least_distance(ends_at(placement, 0)) >= APART - 1e-9


def test_one_end_alone_is_where_it_always_was() -> None:
    _, placement = placed(star(1))
    np.testing.assert_array_equal(
        ends_at(placement, 0)[0], placement.centers[0] + placement.sizes[0] * [0, 0, 0.5]
    )


def test_ends_are_on_the_side_that_their_hyperedges_go_to() -> None:
    document = star(4, position=[0, 0, 0], shape={"type": "box", "size": [2, 2, 1]})
    for item, at in zip(document["items"][1:], [(9, 0), (0, 9), (-9, 0), (0, -9)], strict=True):
        item["position"] = [*at, 0]
    _, placement = placed(document)
    ends = ends_at(placement, 0)
    assert ends[0, 0] > ends[2, 0]
    assert ends[1, 1] > ends[3, 1]


def test_parallel_hyperedges_end_in_the_same_order_at_both_ends() -> None:
    document = {
        "items": [
            {"id": "a", "position": [0, 0, 0], "shape": {"type": "box", "size": [1, 3, 1]}},
            {"id": "b", "position": [9, 0, 0], "shape": {"type": "box", "size": [1, 3, 1]}},
        ],
        "hyperedges": [
            {"id": str(number), "attachments": [{"item": "a"}, {"item": "b"}]}
            for number in range(5)
        ],
    }
    _, placement = placed(document)
    orders = [np.argsort(ends_at(placement, item)[:, 1]).tolist() for item in (0, 1)]
    assert orders[0] == orders[1]


def test_what_shares_a_named_point_is_spread_around_it_within_the_item() -> None:
    document = star(
        3,
        shape={"type": "box", "size": [2, 1, 1]},
        attachment_points=[{"id": "east", "position": [1, 0, 0], "direction": [1, 0, 0]}],
    )
    for hyperedge in document["hyperedges"]:
        hyperedge["attachments"][0]["point"] = "east"
    _, placement = placed(document)
    ends = ends_at(placement, 0) - placement.centers[0]
    np.testing.assert_allclose(ends[:, 0], 1.0)
    assert (np.abs(ends[:, 1:]) <= 0.5 + 1e-9).all()
    assert least_distance(ends) >= APART - 1e-9


def test_a_hyperedge_that_attaches_to_an_item_twice_has_two_places_there() -> None:
    document = star(1)
    document["hyperedges"][0]["attachments"] = [{"item": "hub"}, {"item": "hub"}]
    _, placement = placed(document)
    assert least_distance(ends_at(placement, 0)) >= APART - 1e-9


@pytest.mark.parametrize(
    "layout", [{"curves": "prose"}, {"fidelity": "paper"}, {"clearance": None}]
)
def test_the_papers_curves_end_at_their_points(layout: dict[str, Any]) -> None:
    _, placement = placed(star(3) | {"layout": layout})
    assert least_distance(ends_at(placement, 0)) == 0.0


def test_a_new_hyperedge_takes_a_free_place_and_moves_no_other() -> None:
    before, placement = placed(star(3))
    document = star(4)
    after = Program.model_validate(document)
    standing = Standing.of(before, placement)
    grown = place(after, load_notation(after.notation), standing)
    old, new = ends_at(placement, 0), ends_at(grown, 0)
    np.testing.assert_array_equal(new[:3], old)
    assert least_distance(new) >= APART - 1e-9


def test_places_go_with_an_item_that_moves() -> None:
    document = star(3, position=[0, 0, 0])
    before, placement = placed(document)
    document["items"][0]["position"] = [0, 0, 5]
    after = Program.model_validate(document)
    moved = place(after, load_notation(after.notation), Standing.of(before, placement))
    np.testing.assert_allclose(ends_at(moved, 0), ends_at(placement, 0) + np.array([0, 0, 5]))


def test_places_are_the_same_after_a_restart() -> None:
    program = Program.model_validate(star(5))
    laid = lay_out(program)
    again = read_layout(program, write_layout(laid))
    assert again is not None
    for name in ("attachment_positions", "attachment_directions"):
        np.testing.assert_array_equal(getattr(again.placement, name), getattr(laid.placement, name))


def test_a_huge_item_has_no_more_slots_than_are_wanted() -> None:
    for solid in (Box((1e6, 1e6, 1e6), 0.1), Sphere(1e6), Cylinder(1e6, 1e6, 0.1), Cone(1e6, 1e6)):
        slots = np.concatenate(default_slots(solid, size_of(solid), 10, 0.2, 0.1))
        assert 10 <= len(slots) < 1000


SOLIDS: tuple[Solid, ...] = (
    Box((2.0, 1.0, 0.5), 0.05),
    Text("letters", 0.5, 0.1),
    Tray((3.0, 2.0, 0.5), 0.2, 0.1),
    Sphere(0.8),
    Cylinder(0.6, 1.5, 0.05),
    Cone(0.8, 1.2),
    Arrow(3.0, 0.3),
)


@pytest.mark.parametrize("solid", SOLIDS)
@pytest.mark.parametrize("pitch", [0.21, 0.42])
def test_slots_are_a_pitch_apart_on_the_item(solid: Solid, pitch: float) -> None:
    size = size_of(solid)
    slots = np.concatenate(default_slots(solid, size, 20, pitch, 0.1))
    assert least_distance(slots[:, :3]) >= pitch - 1e-9
    assert (np.abs(slots[:, :3]) <= np.array(size) / 2 + 1e-9).all()
    np.testing.assert_allclose(np.linalg.norm(slots[:, 3:], axis=1), 1.0)
