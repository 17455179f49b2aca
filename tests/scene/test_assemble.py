from __future__ import annotations

import numpy as np
import pytest

from app.errors import UnknownName
from tests.scene.hand_built import (
    CUBE,
    material_of,
    node_named,
    placed,
    program_of,
    scene_of,
    seen_by,
    three_items,
)


def test_items_come_first_then_hyperedges_then_the_ground() -> None:
    scene = scene_of(three_items())
    assert [(node.name, node.shows) for node in scene.nodes] == [
        ("x", "item"),
        ("y", "item"),
        ("z", "item"),
        ("e", "hyperedge"),
        ("f", "hyperedge"),
        ("ground", "ground"),
    ]


def test_equal_materials_are_one() -> None:
    scene = scene_of(three_items())
    assert len(set(scene.materials)) == len(scene.materials)
    bodies = {node_named(scene, name).primitives[0].material for name in "xyz"}
    assert len(bodies) == 1


def test_bounds_hold_items_and_hyperedges_but_not_the_ground() -> None:
    scene = scene_of(three_items(style={"labels": False}))
    assert scene.bounds == pytest.approx(np.array([[-0.5, -0.5, -0.5], [4.5, 0.5, 2.5]]), abs=1e-6)


def test_the_ground_lies_at_the_lowest_point() -> None:
    assert node_named(scene_of(three_items()), "ground").translation[2] == pytest.approx(-0.5)


def test_there_is_no_ground_without_wish_or_without_anything_on_it() -> None:
    for program in (three_items(style={"ground": False}), program_of(items=[])):
        assert all(node.shows != "ground" for node in scene_of(program).nodes)


def test_the_camera_sees_everything_in_the_aspect_asked_for() -> None:
    scene = scene_of(three_items(), aspect=2.0)
    assert scene.camera.aspect == 2.0
    vertices = np.concatenate(
        [
            part.mesh.vertices + np.array(node.translation)
            for node in scene.nodes
            if node.shows != "ground"
            for part in node.primitives
        ]
    )
    seen = np.abs(seen_by(scene.camera, vertices)[:, :2])
    assert seen.max() == pytest.approx(0.9, abs=1e-6)


def test_a_colour_of_the_background_is_light_and_transparent_is_none() -> None:
    grey = scene_of(three_items(style={"background": "#808080"}))
    assert grey.background == pytest.approx((0.2158605,) * 3)
    assert scene_of(three_items(style={"background": "transparent"})).background is None


def test_an_empty_program_is_an_empty_scene_with_a_camera_and_light() -> None:
    scene = scene_of(program_of(items=[]))
    assert scene.nodes == ()
    assert scene.materials == ()
    assert not scene.bounds.any()
    assert np.isfinite(scene.camera.position).all()
    assert len(scene.lights) == 3


def test_items_alone_are_a_scene() -> None:
    scene = scene_of(program_of(items=[{"id": "x"}]))
    assert [node.name for node in scene.nodes] == ["x", "ground"]
    assert material_of(scene, "x").startswith("matte #")


def test_turned_items_are_framed_as_they_stand() -> None:
    program = program_of(items=[{"id": "x"}])
    placement = placed(program, solids=[CUBE])
    placement.rotations[0] = [0, 0, np.sin(np.pi / 8), np.cos(np.pi / 8)]
    bounds = scene_of(program, placement=placement).bounds
    diagonal = 0.5 * np.sqrt(2) - 0.05 * (np.sqrt(2) - 1)  # less what rounding takes off an edge
    assert bounds[1, 0] == pytest.approx(diagonal, abs=0.003)


def test_an_unknown_palette_is_an_error_even_without_hyperedges() -> None:
    with pytest.raises(UnknownName, match="no palette 'rainbow'"):
        scene_of(program_of(items=[], style={"palette": "rainbow"}))


def test_the_same_program_is_the_same_scene() -> None:
    one, other = scene_of(three_items()), scene_of(three_items())
    assert one.materials == other.materials
    assert one.camera.position == other.camera.position
    assert [node.extras for node in one.nodes] == [node.extras for node in other.nodes]
