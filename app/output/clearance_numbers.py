"""The certificate of a layout in words that a program can read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.hyperedges.clearance.certificate import Certificate
from app.hyperedges.pinches import Pinches
from app.hyperedges.routing import Routing
from app.output.remedies import remedies
from app.placement.placement import Placement
from app.program.model import Program


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is proven of a routing, and what is wrong with its curves."""

    certificate: Certificate
    pinches: Pinches


def clearance_numbers(
    program: Program, placement: Placement, routing: Routing, verdict: Verdict
) -> dict[str, Any]:
    """The verdict with ids for numbers; distances are proven lower bounds, in document units."""
    certificate = verdict.certificate
    nearest = certificate.nearest
    own = certificate.own
    ids = [hyperedge.id for hyperedge in program.hyperedges]
    numbers = {
        "required": certificate.required,
        "certified": certificate.certified,
        "minimum": certificate.minimum,
        "nearest": nearest
        and {
            **_names(program, nearest.with_item, nearest.first, nearest.second),
            "place": list(nearest.place),
            "distance": nearest.lower,
        },
        "conflicts": list(_conflicts(program, placement, certificate)),
        "own_contacts": [
            {"hyperedge": ids[number], "place": place, "distance": distance}
            for number, place, distance in zip(
                own.hyperedges.tolist(), own.places.tolist(), own.lower.tolist(), strict=True
            )
        ],
        "pinches": list(_pinches(ids, routing, verdict.pinches)),
    }
    return numbers if certificate.complete else {**numbers, "complete": False}


def _names(program: Program, with_item: bool, first: int, second: int) -> dict[str, Any]:
    names = [program.hyperedges[first].id]
    if with_item:
        return {"hyperedges": names, "item": program.items[second].id}
    return {"hyperedges": [*names, program.hyperedges[second].id], "item": None}


def _conflicts(
    program: Program, placement: Placement, certificate: Certificate
) -> Iterator[dict[str, Any]]:
    found = certificate.conflicts
    columns = (found.with_items, found.first, found.second, found.places, found.lower)
    words = remedies(program, placement, found, certificate.required)
    for with_item, first, second, place, distance, remedy in zip(
        *(column.tolist() for column in columns), words, strict=True
    ):
        yield {
            **_names(program, with_item, first, second),
            "place": place,
            "distance": distance,
            "remedy": remedy,
        }


def _pinches(ids: list[str], routing: Routing, pinches: Pinches) -> Iterator[dict[str, Any]]:
    starts = routing.segment_starts
    owners = np.searchsorted(starts, pinches.segments, side="right") - 1
    for owner, segment, radius in zip(
        owners.tolist(), pinches.segments.tolist(), pinches.radii.tolist(), strict=True
    ):
        yield {
            "hyperedge": ids[owner],
            "segment": segment - int(starts[owner]),
            "radius_of_curvature": radius,
        }
