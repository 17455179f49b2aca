from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from app.errors import DocumentTooLarge, Unprintable
from app.output.media import Parts
from app.output.shells import refuse_too_many, shells, triangles_of
from app.program.reading import read_program
from app.scene.scene import Scene
from app.settings import Settings
from app.staging import bodies_for_print, make_scene
from tests.output.scenes import box, matte, node, scene

EXAMPLES = Path(__file__).parents[2] / "examples"
TURNED = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))

BOXES = scene(
    [node("a", box(2, 1, 1), 0, (-3, 5, 0.5)), node("b", box(1, 1, 3), 1, (4, 0, 1.5))],
    [matte("#ff0000"), matte("#0000ff")],
)


def printed_scene(document: dict[str, Any] | bytes) -> Scene:
    """The scene of a document, with tubes for printing."""
    data = document if isinstance(document, bytes) else json.dumps(document).encode()
    return make_scene(read_program(data, Settings()), 4 / 3, sweeping=bodies_for_print(10**9))


def as_body(vertices: Any, faces: Any) -> trimesh.Trimesh:
    return trimesh.Trimesh(vertices, faces, process=True)


def test_millimetres_begin_at_the_lowest_corner() -> None:
    found = list(shells(BOXES, "all", 10.0))
    assert [shell.name for shell in found] == ["a", "b"]
    bounds = np.array([[np.min(s.vertices, axis=0), np.max(s.vertices, axis=0)] for s in found])
    np.testing.assert_allclose(bounds[0], [[0, 50, 0], [20, 60, 10]], atol=1e-5)
    np.testing.assert_allclose(bounds[1], [[75, 0, 0], [85, 10, 30]], atol=1e-5)


def test_items_are_turned_as_they_are_in_the_scene() -> None:
    lying = node("a", box(4, 1, 1), 0)
    turned = type(lying)("a", "item", lying.primitives, (0.0, 0.0, 0.0), TURNED, {})
    (shell,) = shells(scene([turned], [matte("#fff000")]), "all", 1.0)
    np.testing.assert_allclose(np.ptp(shell.vertices, axis=0), [1, 4, 1], atol=1e-5)
    assert as_body(shell.vertices, shell.faces).volume == pytest.approx(4, rel=1e-5)


def test_the_ground_is_never_printed() -> None:
    assert "ground" not in [shell.name for shell in shells(BOXES, "all", 1.0)]


@pytest.mark.parametrize("name", ["id3-clause-1", "shapes", "unicode"])
def test_everything_in_the_examples_is_closed(name: str) -> None:
    found = list(shells(printed_scene((EXAMPLES / f"{name}.json").read_bytes()), "all", 10.0))
    for shell in found:
        body = as_body(shell.vertices, shell.faces)
        assert body.is_watertight, shell.name
        assert body.is_winding_consistent, shell.name
        assert all(part.volume > 0 for part in body.split(only_watertight=False)), shell.name


@pytest.mark.parametrize(
    ("parts", "names"),
    [("all", ["x", "x", "y", "e"]), ("items", ["x", "x", "y"]), ("hyperedges", ["e"])],
)
def test_parts_are_printed_alone(parts: Parts, names: list[str]) -> None:
    document = {
        "items": [{"id": "x", "label": "X"}, {"id": "y"}],
        "hyperedges": [{"id": "e", "attachments": [{"item": "x"}, {"item": "y"}]}],
    }
    found = printed_scene(document)
    assert [shell.name for shell in shells(found, parts, 10.0)] == names
    assert triangles_of(found, parts) >= sum(len(s.faces) for s in shells(found, parts, 10.0))


def far_apart(distance: float, radius: float) -> dict[str, Any]:
    """A relation of three near the origin, and an item far away."""
    places = {"x": [0, 0, 0], "y": [2, 0, 0], "z": [1, 2, 0], "far": [distance, 0, 0]}
    return {
        "items": [{"id": name, "position": place} for name, place in places.items()],
        "hyperedges": [
            {"id": "e", "radius": radius, "attachments": [{"item": name} for name in "xyz"]}
        ],
    }


def test_a_hyperedge_stays_closed_where_the_scene_is_wide() -> None:
    *_, shell = shells(printed_scene(far_apart(-1e4, 0.08)), "all", 10.0)
    assert as_body(shell.vertices, shell.faces).is_watertight


def test_a_hyperedge_too_fine_for_its_scene_is_named() -> None:
    with pytest.raises(Unprintable, match="'e' cannot be printed"):
        list(shells(printed_scene(far_apart(-1e6, 0.001)), "all", 10.0))


def test_nothing_has_no_shells() -> None:
    assert list(shells(printed_scene({"items": []}), "all", 10.0)) == []


def test_too_many_triangles_are_refused() -> None:
    refuse_too_many(10, 10)
    with pytest.raises(DocumentTooLarge, match="11 triangles is more than the limit of 10"):
        refuse_too_many(11, 10)
