from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.pinches import find_pinches
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.layout import Layout
from app.placement.placement import Placement
from benchmarks.random_programs import CLEARANCE, random_program
from tests.hyperedges.layouts import assert_clear, ids, laid, same
from tests.hyperedges.scenes import placement as placement_of


def routed(
    placement: Placement,
    routing: Literal["planes", "elastic", "auto"],
    heights: Floats | None = None,
) -> Routing:
    return route(placement, routing=routing, clearance=CLEARANCE, join_heights=heights)


def equal(one: Routing, other: Routing) -> bool:
    return one.control_points.tobytes() == other.control_points.tobytes()


def faults(routing: Routing, placement: Placement) -> tuple[int, int]:
    """Conflicts, and pinches and own contacts."""
    found = certify(routing, placement, CLEARANCE)
    pinches = find_pinches(routing)
    return len(found.conflicts), len(pinches.segments) + len(found.own.hyperedges)


def test_auto_is_elastic_where_that_is_clear() -> None:
    placement = random_program(10, 3).placement()
    assert equal(routed(placement, "auto"), routed(placement, "elastic"))
    assert not equal(routed(placement, "auto"), routed(placement, "planes"))


def test_auto_is_in_planes_where_one_is_given() -> None:
    placement = random_program(10, 3).placement()
    heights = np.full(10, np.nan)
    heights[4] = 3.0
    assert equal(routed(placement, "auto", heights), routed(placement, "planes", heights))


@pytest.mark.parametrize("seed", range(2))
def test_auto_takes_what_leaves_fewer_faults(seed: int) -> None:
    # Attachments so near each other that nothing can be clear.
    chance = np.random.default_rng(seed)
    placement = placement_of(chance.uniform(0.0, 1.0, (24, 3)), list(range(0, 25, 3)))
    planes, elastic, auto = (
        faults(made, placement)
        for made in (
            routed(placement, "planes"),
            routed(placement, "elastic"),
            routed(placement, "auto"),
        )
    )
    assert min(planes, elastic) > (0, 0)
    assert auto == min(planes, elastic)


def wishing(document: dict[str, Any], routing: str) -> dict[str, Any]:
    """The document, routed in another way."""
    return {**document, "layout": {**document["layout"], "routing": routing}}


def with_routing(document: dict[str, Any], layout: Layout) -> Layout:
    """A layout as if it had been wished for by ``document``."""
    program = laid({**document, "hyperedges": []}).program.layout
    return replace(layout, program=layout.program.model_copy(update={"layout": program}))


@pytest.mark.parametrize("kind", ["elastic", "planes"])
def test_after_an_edit_auto_routes_as_the_layout_before_was_routed(kind: str) -> None:
    document = random_program(10, 3).document()
    fewer = {**document, "hyperedges": document["hyperedges"][:-1]}
    before = laid(wishing(fewer, kind))
    assert before.routing.is_elastic == (kind == "elastic")
    expected = laid(wishing(document, kind), before)
    after = laid(wishing(document, "auto"), with_routing(wishing(document, "auto"), before))
    assert same(before, after) == set(ids(fewer))
    assert same(expected, after) == set(ids(document))
    assert after.routing.is_elastic == before.routing.is_elastic


def crowded(count: int, seed: int, share: float) -> dict[str, Any]:
    """A random program with its items nearer to each other."""
    document = random_program(count, seed).document(routing="auto")
    for item in document["items"]:
        x, y, z = item["position"]
        item["position"] = [share * x, share * y, z]
    return document


def test_what_is_new_frees_what_it_comes_too_near_to_but_not_all() -> None:
    document = crowded(8, 3, 0.75)
    fewer = {**document, "hyperedges": document["hyperedges"][:-1]}
    before = laid(fewer)
    assert_clear(before)
    after = laid(document, before)
    assert_clear(after)
    assert 0 < len(same(before, after)) < len(fewer["hyperedges"])
    assert after.routing.is_elastic


def test_the_own_item_that_has_become_larger_is_in_the_way() -> None:
    # The point stays where it is, while the block grows around the tube.
    point = {"id": "p", "position": [0.5, 0, 0.5], "direction": [1, 0, 0]}

    def document(width: float) -> dict[str, Any]:
        block = {"type": "box", "size": [width, 1, 1]}
        items = [
            {"id": "a", "shape": block, "position": [0, 0, 0], "attachment_points": [point]},
            {"id": "b", "shape": {"type": "sphere", "radius": 0.3}, "position": [4, 0, 1]},
        ]
        ends = [{"item": "a", "point": "p"}, {"item": "b"}]
        hyperedges = [{"id": "e", "attachments": ends}]
        return {"items": items, "hyperedges": hyperedges, "layout": {"routing": "elastic"}}

    before = laid(document(1.0))
    after = laid(document(3.0), before)
    attached = "attachment_positions"
    np.testing.assert_array_equal(
        getattr(before.placement, attached), getattr(after.placement, attached)
    )
    assert not certify(before.routing, after.placement, 0.05).certified
    assert same(before, after) == set()
    assert_clear(after)
