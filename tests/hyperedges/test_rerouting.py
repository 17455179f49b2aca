from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.pinches import find_pinches
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from benchmarks.random_programs import CLEARANCE, random_program
from tests.hyperedges.scenes import placement as placement_of


def routed(
    placement: Placement,
    routing: Literal["planes", "elastic", "auto"],
    heights: Floats | None = None,
) -> Routing:
    return route(placement, routing=routing, clearance=CLEARANCE, join_heights=heights)


def same(one: Routing, other: Routing) -> bool:
    return one.control_points.tobytes() == other.control_points.tobytes()


def faults(routing: Routing, placement: Placement) -> tuple[int, int]:
    """Conflicts, and pinches and own contacts."""
    found = certify(routing, placement, CLEARANCE)
    pinches = find_pinches(routing)
    return len(found.conflicts), len(pinches.segments) + len(found.own.hyperedges)


def test_auto_is_elastic_where_that_is_clear() -> None:
    placement = random_program(10, 3).placement()
    assert same(routed(placement, "auto"), routed(placement, "elastic"))
    assert not same(routed(placement, "auto"), routed(placement, "planes"))


def test_auto_is_in_planes_where_one_is_given() -> None:
    placement = random_program(10, 3).placement()
    heights = np.full(10, np.nan)
    heights[4] = 3.0
    assert same(routed(placement, "auto", heights), routed(placement, "planes", heights))


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
