"""Placements as plane drawings."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from app.formats import registry
from app.notations.loader import load_notation
from app.placement.flat import flattened
from app.placement.place import place
from app.placement.placement import Placement
from app.placement.turning import UNTURNED
from app.program.model import Program
from app.scene.camera import view_of
from app.settings import Settings

EXAMPLES = Path(__file__).parents[2] / "examples"


def program_of(document: dict[str, Any]) -> Program:
    return registry.read("tubeloom", json.dumps(document).encode(), Settings())


def flat(program: Program) -> Placement:
    return flattened(place(program, load_notation(program.notation)), program)


def test_every_label_can_be_read_from_above() -> None:
    program = program_of(json.loads((EXAMPLES / "id3-clause-2.json").read_bytes()))
    labels = [label for label in flat(program).labels if label is not None]
    assert len(labels) == sum(item.label is not None for item in program.items)
    assert all(label.rotation == UNTURNED for label in labels)


def test_hyperedges_end_at_the_side_of_an_item_that_faces_the_others() -> None:
    program = program_of(
        {
            "items": [
                {"id": "a", "shape": {"type": "box", "size": [2, 1, 1]}, "position": [0, 0, 0]},
                {"id": "b", "shape": {"type": "box", "size": [2, 1, 1]}, "position": [9, 0, 0]},
            ],
            "hyperedges": [
                {"id": "e", "radius": 0.1, "attachments": [{"item": "a"}, {"item": "b"}]}
            ],
        }
    )
    found = flat(program)
    assert np.allclose(found.attachment_positions[:, :2], [[0.9, 0], [8.1, 0]])
    assert np.allclose(found.attachment_directions, [[1, 0, 0], [-1, 0, 0]])


def test_an_attachment_point_stays_where_it_is_seen_from_above() -> None:
    point = {"id": "p", "position": [0.3, 0.2, 0.5]}
    program = program_of(
        {
            "items": [
                {"id": "a", "position": [1, 2, 0], "attachment_points": [point]},
                {"id": "b", "position": [5, 2, 0]},
            ],
            "hyperedges": [
                {"id": "e", "attachments": [{"item": "a", "point": "p"}, {"item": "b"}]}
            ],
        }
    )
    found = flat(program)
    assert np.allclose(found.attachment_positions[0, :2], [1.3, 2.2])
    assert np.allclose(np.linalg.norm(found.attachment_directions, axis=1), 1)
    assert np.allclose(found.attachment_directions[:, 2], 0)


def test_items_stay_where_they_are() -> None:
    program = program_of(json.loads((EXAMPLES / "id3-clause-2.json").read_bytes()))
    known, found = place(program, load_notation(program.notation)), flat(program)
    assert np.array_equal(found.centers, known.centers)
    assert np.array_equal(found.sizes, known.sizes)


def test_a_flat_drawing_is_seen_from_straight_above() -> None:
    items: list[dict[str, Any]] = [{"id": "a"}]
    wished = {"from": [1, 0, 0], "margin": 0.2}
    program = program_of({"items": items, "layout": {"dimensions": 2}, "view": wished})
    view = view_of(program, "rows")
    assert (view.projection, view.from_, view.margin) == ("orthographic", (0.0, 0.0, 1.0), 0.2)
    assert view_of(program_of({"items": items, "view": wished}), "rows").from_ == (1, 0, 0)
