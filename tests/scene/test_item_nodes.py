from __future__ import annotations

import numpy as np
import pytest

from app.notations.notation import ItemStyle, Notation
from app.scene.grain import VARIANTS
from app.scene.item_nodes import INKS
from app.solids.meshing import mesh_of
from app.solids.solid import Sphere
from tests.scene.hand_built import (
    CUBE,
    material_of,
    node_named,
    placed,
    program_of,
    scene_of,
    three_items,
)

GATES = Notation(
    name="gates",
    title="Gates",
    description="For these tests.",
    items={"gate": ItemStyle(material="metal", color="#204060", label_color="#fedcba")},
    other_items=ItemStyle(color="#dddddd"),
)


def test_an_item_stands_where_it_was_placed() -> None:
    program = three_items()
    node = node_named(scene_of(program), "z")
    assert node.translation == (4.0, 0.0, 0.0)
    assert node.rotation == (0.0, 0.0, 0.0, 1.0)
    assert node.primitives[0].mesh is mesh_of(CUBE)


def test_its_label_is_the_second_part_in_the_items_own_axes() -> None:
    node = node_named(scene_of(three_items()), "z")
    body, label = node.primitives
    low, high = label.mesh.bounds
    assert low[1] == pytest.approx(-0.525), "half of the letter stands out of the front face"
    assert high[1] == pytest.approx(-0.475)
    assert high[2] - low[2] == pytest.approx(0.3, rel=0.05), "its letters stand upright"
    assert np.linalg.norm(label.mesh.normals, axis=1) == pytest.approx(1, abs=1e-5)
    assert body.material != label.material


def test_items_of_one_shape_share_one_mesh_and_equal_labels_another() -> None:
    program = program_of(items=[{"id": name, "label": "same"} for name in "abc"])
    a, b, c = scene_of(program).nodes[:3]
    assert a.primitives[0].mesh is b.primitives[0].mesh is c.primitives[0].mesh
    assert a.primitives[1].mesh is b.primitives[1].mesh is c.primitives[1].mesh


def test_textured_items_of_one_shape_share_few_meshes_and_their_coordinates() -> None:
    names = [f"item {number}" for number in range(30)]
    program = program_of(items=[{"id": name, "material": "wood"} for name in names])
    nodes = scene_of(program).nodes[:30]
    meshes = {id(node.primitives[0].mesh): node.primitives[0].mesh for node in nodes}
    assert len(meshes) == VARIANTS, "so that neighbours are not clones"
    assert all(mesh.coordinates is not None for mesh in meshes.values())
    again = scene_of(program).nodes[:30]
    assert [node.primitives[0].mesh for node in again] == [
        node.primitives[0].mesh for node in nodes
    ]


def test_only_bodies_with_a_texture_have_coordinates() -> None:
    items = [
        {"id": "w", "material": "wood", "label": "W"},
        {"id": "s", "material": "stone", "label": "S"},
        {"id": "p", "label": "P"},
    ]
    scene = scene_of(program_of(items=items))
    textured = [
        [part.mesh.coordinates is not None for part in node_named(scene, name).primitives]
        for name in "wsp"
    ]
    assert textured == [[True, False], [True, False], [False, False]]
    assert node_named(scene, "p").primitives[0].mesh is mesh_of(CUBE)


def test_without_labels_there_are_only_bodies() -> None:
    scene = scene_of(three_items(style={"labels": False}))
    assert [len(node.primitives) for node in scene.nodes] == [1] * 6


def test_a_blank_label_shows_nothing() -> None:
    node = node_named(scene_of(program_of(items=[{"id": "x", "label": " "}])), "x")
    assert len(node.primitives) == 1


def test_its_kind_says_how_an_item_looks_and_the_item_has_the_last_word() -> None:
    items = [
        {"id": "kind", "kind": "gate", "label": "A"},
        {"id": "own", "kind": "gate", "color": "#fff", "material": "glass"},
        {"id": "other", "kind": "unheard of"},
    ]
    scene = scene_of(program_of(items=items), notation=GATES)
    assert material_of(scene, "kind") == "metal #204060"
    assert material_of(scene, "kind", part=1) == "matte #fedcba"
    assert material_of(scene, "own") == "glass #ffffff"
    assert material_of(scene, "other") == "matte #dddddd"


@pytest.mark.parametrize(
    ("paper", "ink"), [("#ffffff", INKS[0]), ("#f0d0b0", INKS[0]), ("#101010", "#fedcba")]
)
def test_a_label_can_be_read_on_any_colour(paper: str, ink: str) -> None:
    items = [{"id": "x", "kind": "gate", "label": "X", "color": paper}]
    scene = scene_of(program_of(items=items), notation=GATES)
    assert material_of(scene, "x", part=1) == f"matte {ink}"


def test_extras_hand_through_what_the_document_says() -> None:
    scene = scene_of(three_items())
    assert node_named(scene, "x").extras == {
        "shows": "item",
        "id": "x",
        "kind": "variable",
        "label": "X",
        "data": {"line": [1, {"größe": None}]},
    }
    assert node_named(scene, "y").extras == {"shows": "item", "id": "y", "parent": "x"}


def test_each_solid_has_its_own_mesh() -> None:
    program = program_of(items=[{"id": "a"}, {"id": "b"}])
    placement = placed(program, solids=[CUBE, Sphere(0.5)])
    a, b = scene_of(program, placement=placement).nodes[:2]
    assert a.primitives[0].mesh is mesh_of(CUBE)
    assert b.primitives[0].mesh is mesh_of(Sphere(0.5))
