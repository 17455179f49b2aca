"""Each conflict says what would make room, and that does make room."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from app.hyperedges.clearance.conflicts import Conflicts
from app.layout import judge, lay_out
from app.output.clearance_numbers import clearance_numbers
from app.output.remedies import remedies
from app.program.reading import read_program
from app.settings import Settings
from tests.service import Service


def conflicts(document: dict[str, Any]) -> list[dict[str, Any]]:
    program = read_program(json.dumps(document).encode(), Settings())
    layout = lay_out(program)
    verdict = judge(layout)
    assert verdict is not None
    found = clearance_numbers(program, layout.placement, layout.routing, verdict)
    return list(found["conflicts"])


def two(points: list[dict[str, Any]], ends: list[dict[str, Any]]) -> dict[str, Any]:
    """Two hyperedges from item a, where each has one of the ``ends``, to items of their own."""
    return {
        "items": [
            {"id": "a", "attachment_points": points, "position": [0, 0, 0.5]},
            {"id": "b", "position": [5, 3, 0.5]},
            {"id": "c", "position": [5, -3, 0.5]},
        ],
        "hyperedges": [
            {"id": other, "attachments": [{"item": "a", **end}, {"item": other}]}
            for other, end in zip(("b", "c"), ends, strict=True)
        ],
    }


def point(name: str, y: float) -> dict[str, Any]:
    return {"id": name, "position": [0.5, y, 0.0], "direction": [1, 0, 0]}


ENDS = [{"point": "p"}, {"point": "q"}]


def test_points_that_are_too_near_are_to_be_moved_apart() -> None:
    (found,) = conflicts(two([point("p", 0.05), point("q", -0.05)], ENDS))
    assert found["remedy"] == (
        "Move the points of 'a' apart ('p' and 'q'): the ends there are 0.1 apart, where 0.42 is "
        "enough."
    )
    assert not conflicts(two([point("p", 0.21), point("q", -0.21)], ENDS))


def test_items_that_stand_in_the_way_are_to_be_moved() -> None:
    document: dict[str, Any] = {
        "items": [
            {"id": "a", "position": [0, 0, 1]},
            {"id": "b", "position": [0.5, 0, 1]},
            {"id": "c", "position": [6, 0, 1]},
        ],
        "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "c"}]}],
    }
    document["items"][0]["attachment_points"] = [
        {"id": "east", "position": [0.5, 0, 0], "direction": [1, 0, 0]}
    ]
    document["hyperedges"][0]["attachments"][0]["point"] = "east"
    (found,) = conflicts(document)
    assert found["item"] == "b"
    assert found["remedy"] == "Move 'b' away from 'a', or attach on another side of 'a'."
    document["items"][1]["position"] = [0.5, 4, 1]
    assert not conflicts(document)


@pytest.mark.parametrize(
    ("with_item", "second", "place", "words"),
    [
        (True, 0, [0.6, 0.0, 0.5], "Let the point 'p' on 'a' face outwards, or leave its"),
        (True, 2, [3.0, 0.0, 0.5], "Move 'c' out of the way, or the items between which it"),
        (False, 1, [3.0, 0.0, 0.5], "Move the items between which both run farther apart, or"),
    ],
)
def test_what_is_wrong_elsewhere_has_a_remedy_too(
    with_item: bool, second: int, place: list[float], words: str
) -> None:
    document = two([point("p", 0.3), point("q", -0.3)], ENDS)
    program = read_program(json.dumps(document).encode(), Settings())
    found = Conflicts(
        np.array([with_item]),
        np.array([0]),
        np.array([second]),
        np.array([place]),
        np.zeros(1),
        np.zeros(1),
    )
    (remedy,) = remedies(program, lay_out(program).placement, found, 0.05)
    assert remedy.startswith(words)


def test_remedies_are_told_over_http(usual_service: Service) -> None:
    document = two([point("p", 0.05), point("q", -0.05)], ENDS)
    with usual_service.client() as client:
        found = client.post("/v1/layout", json=document).json()["clearance"]
    assert [conflict["remedy"][:4] for conflict in found["conflicts"]] == ["Move"]
