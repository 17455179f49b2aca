from __future__ import annotations

import numpy as np
import pytest

from app.notations.notation import HyperedgeStyle, Notation
from app.scene.palette import palette
from app.tubes.tubes import Tubes
from tests.scene.hand_built import (
    balls,
    material_of,
    node_named,
    program_of,
    scene_of,
    three_items,
)

CLOCKS = Notation(
    name="clocks",
    title="Clocks",
    description="For these tests.",
    hyperedges={"clock": HyperedgeStyle(material="metal", color="#101820")},
)
PALETTE = palette("glasbey").colors


def test_a_hyperedge_is_drawn_around_its_own_middle() -> None:
    tubes = balls(np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]))
    scene = scene_of(three_items(), tubes=tubes)
    node = node_named(scene, "f")
    (part,) = node.primitives
    assert node.translation == pytest.approx((4, 5, 6))
    assert part.mesh.bounds.mean(axis=0) == pytest.approx([0, 0, 0], abs=1e-6)
    moved = part.mesh.vertices + np.array(node.translation)
    assert moved == pytest.approx(tubes.mesh(1).vertices, abs=1e-6)
    assert np.array_equal(part.mesh.faces, tubes.mesh(1).faces)
    assert np.array_equal(part.mesh.normals, tubes.mesh(1).normals)


def test_far_from_the_origin_no_more_is_lost_than_the_tubes_had_lost() -> None:
    far = np.array([[1e6, -2e5, 3e4], [0.0, 0.0, 0.0]])
    tubes = balls(far)
    node = node_named(scene_of(three_items(), tubes=tubes), "e")
    moved = node.primitives[0].mesh.vertices.astype(np.float64) + node.translation
    assert np.array_equal(moved, tubes.mesh(0).vertices.astype(np.float64))


def test_only_hyperedges_with_a_texture_have_coordinates() -> None:
    ends = [{"item": "x"}, {"item": "y"}]
    program = program_of(
        items=[{"id": "x"}, {"id": "y"}],
        hyperedges=[
            {"id": name, "material": name, "attachments": ends}
            for name in ("wood", "stone", "plastic")
        ],
    )
    scene = scene_of(program)
    for name in ("wood", "stone", "plastic"):
        (part,) = node_named(scene, name).primitives
        assert (part.mesh.coordinates is not None) == (name != "plastic")


def test_every_hyperedge_has_its_own_colour_in_the_order_of_the_document() -> None:
    scene = scene_of(three_items())
    assert material_of(scene, "e") == f"plastic {PALETTE[0]}"
    assert material_of(scene, "f") == f"plastic {PALETTE[1]}"


def test_given_colours_win_and_leave_the_others_alone() -> None:
    ends = [{"item": "x"}, {"item": "y"}]
    hyperedges = [
        {"id": "given", "kind": "clock", "color": "#abc", "material": "glass", "attachments": ends},
        {"id": "kind", "kind": "clock", "attachments": ends},
        {"id": "palette", "attachments": ends},
    ]
    program = program_of(items=[{"id": "x"}, {"id": "y"}], hyperedges=hyperedges)
    scene = scene_of(program, notation=CLOCKS)
    assert material_of(scene, "given") == "glass #aabbcc"
    assert material_of(scene, "kind") == "metal #101820"
    assert material_of(scene, "palette") == f"plastic {PALETTE[2]}"


def test_colours_that_vanish_on_the_background_are_left_out() -> None:
    program = three_items(style={"palette": "okabe-ito", "background": "#e69f00"})
    assert material_of(scene_of(program), "e") == "plastic #56b4e9"


def test_extras_hand_through_what_the_document_says() -> None:
    scene = scene_of(three_items())
    assert node_named(scene, "e").extras == {
        "shows": "hyperedge",
        "id": "e",
        "kind": "coreference",
        "label": "E",
        "attachments": [{"item": "x"}, {"item": "y"}, {"item": "z"}],
    }
    assert node_named(scene, "f").extras["attachments"] == [
        {"item": "x", "point": "top"},
        {"item": "y"},
    ]


def test_a_hyperedge_without_triangles_is_a_node_all_the_same() -> None:
    one = balls(np.array([[1.0, 2.0, 3.0]]))
    tubes = Tubes(
        one.vertices,
        one.normals,
        one.faces,
        np.array([0, 0, len(one.vertices)]),
        np.array([0, 0, len(one.faces)]),
    )
    scene = scene_of(three_items(), tubes=tubes)
    assert node_named(scene, "e").primitives == ()
    assert node_named(scene, "f").translation == pytest.approx((1, 2, 3))
