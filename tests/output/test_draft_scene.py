"""Scenes as one heap of triangles: moved, sorted and merged, with nothing lost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.output.draft_scene import DraftScene, Normalization, draft_scene
from app.scene.grain import textured
from app.scene.materials import make_material
from app.scene.scene import Node, Primitive, Scene
from app.scene.textures import tint
from tests.output.scenes import (
    ORIGIN,
    UPRIGHT,
    arch,
    box,
    from_above,
    linear,
    matte,
    node,
    scene,
    still_life,
)


def draft(shown: Scene) -> DraftScene:
    return draft_scene(shown, Normalization.of(shown))


def colors_in_order(drawn: DraftScene, section: int) -> np.ndarray:
    """Linear RGB of the triangles of a section, (f, 3)."""
    part = drawn.sections[section]
    corners = drawn.faces[part.first : part.first + part.count, 0]
    return np.asarray(drawn.table[drawn.rows[corners], 0, :3])


def test_every_triangle_is_in_a_section() -> None:
    shown = still_life()
    drawn = draft(shown)
    count = sum(
        len(primitive.mesh.faces)
        for part in shown.nodes
        if part.shows != "ground"
        for primitive in part.primitives
    )
    assert len(drawn.faces) == count
    assert [part.first for part in drawn.sections[1:]] == [
        part.first + part.count for part in drawn.sections[:-1]
    ]
    assert sum(part.count for part in drawn.sections) == count


def test_what_is_drawn_alike_is_one_section_and_the_translucent_come_last() -> None:
    kinds = [(part.shows, part.is_clear) for part in draft(still_life()).sections]
    assert kinds == [("item", False), ("hyperedge", False), ("item", True)]


def test_the_scene_becomes_one_unit_long_around_the_origin() -> None:
    bounds = draft(still_life()).bounds
    assert bounds is not None
    assert np.linalg.norm(bounds[1] - bounds[0]) == pytest.approx(1.0)
    np.testing.assert_allclose(bounds.sum(axis=0), 0.0, atol=1e-6)


@given(
    quaternion=st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
    at=st.tuples(*[st.floats(-100, 100)] * 3),
)
def test_vertices_and_normals_are_where_their_node_puts_them(
    quaternion: tuple[float, float, float, float], at: tuple[float, float, float]
) -> None:
    mesh = box(1, 2, 3)
    x, y, z, w = (np.array(quaternion) / np.linalg.norm(quaternion)).tolist()
    turned = Node("turned", "item", (Primitive(mesh, 0),), at, (x, y, z, w), {})
    shown = scene([node("far", box(1, 1, 1), 0, (200.0, 0.0, 0.0)), turned], [matte("#ffffff")])
    move = Normalization.of(shown)
    rotation = Rotation.from_quat(quaternion)
    drawn = draft(shown)
    own = drawn.rows == 2
    wanted = move.points(rotation.apply(mesh.vertices) + at)
    np.testing.assert_allclose(drawn.positions[own], wanted, atol=1e-5)
    np.testing.assert_allclose(drawn.normals[own], rotation.apply(mesh.normals), atol=1e-5)


def test_meshes_that_nodes_share_are_left_as_they_are() -> None:
    mesh = box(1, 1, 1)
    before = mesh.vertices.copy(), mesh.faces.copy()
    draft(scene([node("one", mesh, 0), node("two", mesh, 0, (2, 0, 0))], [matte("#ffffff")]))
    np.testing.assert_array_equal(mesh.vertices, before[0])
    np.testing.assert_array_equal(mesh.faces, before[1])


def test_the_table_has_the_surface_of_each_row() -> None:
    drawn = draft(scene([node("one", box(1, 1, 1), 0)], [matte("#d55e00")]))
    np.testing.assert_array_equal(drawn.table[0], 0.0)
    np.testing.assert_allclose(drawn.table[1, 0], (*linear("#d55e00"), 1.0), rtol=1e-6)
    np.testing.assert_allclose(drawn.table[1, 1], (0.0, 0.9, 0.0, 0.0), rtol=1e-6)
    assert drawn.table[1, 2, 2] == 1.0


def test_halos_are_so_many_radii_wide_and_only_tubes_have_them() -> None:
    tube = replace(
        node("tube", arch((-3, 0, 0), (3, 0, 0), 1.0, 0.2), 0, ORIGIN, "hyperedge"), radius=0.2
    )
    shown = scene([node("one", box(1, 1, 1), 0), tube], [matte("#d55e00")])
    size = Normalization.of(shown).size
    drawn = draft(replace(shown, halo=0.5))
    np.testing.assert_allclose(drawn.table[:, 2, 0] * size, [0.0, 0.0, 0.1], atol=1e-6)
    np.testing.assert_array_equal(draft(shown).table[:, 2, 0], 0.0)


def test_what_has_a_texture_is_a_section_of_its_own_in_a_tint() -> None:
    wood = make_material("wood", "#b98a5a")
    block = textured(box(1, 1, 1), "wood")
    shown = scene([node("one", box(1, 1, 1), 0), node("two", block, 1)], [matte("#fff000"), wood])
    drawn = draft(shown)
    assert [part.texture for part in drawn.sections] == [None, "wood"]
    assert drawn.coordinates is not None
    assert block.coordinates is not None
    np.testing.assert_array_equal(drawn.coordinates[drawn.rows == 2], block.coordinates)
    red, green, blue, _ = wood.base_color
    np.testing.assert_allclose(drawn.table[2, 0, :3], tint((red, green, blue)), rtol=1e-6)


def test_a_texture_whose_place_nobody_knows_is_left_out() -> None:
    drawn = draft(scene([node("one", box(1, 1, 1), 0)], [make_material("wood", "#b98a5a")]))
    assert drawn.coordinates is None
    assert [part.texture for part in drawn.sections] == [None]


def test_what_stands_in_a_tray_is_drawn_before_the_tray() -> None:
    tray, content = (
        node("tray", box(4, 4, 0.2), 0),
        node("content", box(1, 1, 1), 1, (0.0, 0.0, 0.6)),
    )
    colors = colors_in_order(draft(scene([tray, content], [matte("#ff0000"), matte("#00ff00")])), 0)
    assert colors[0, 1] > colors[-1, 1]


def test_an_empty_scene_has_no_bounds() -> None:
    drawn = draft(scene([], [matte("#ffffff")]))
    assert drawn.bounds is None
    assert drawn.sections == ()
    assert len(drawn.corners) == 0


def test_a_scene_that_is_one_point_is_not_scaled() -> None:
    shown = scene([node("flat", box(0, 0, 0), 0)], [matte("#ffffff")])
    assert Normalization.of(shown).size == 1.0


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_vertex_that_is_not_finite_is_refused(value: float) -> None:
    mesh = box(1, 1, 1)
    mesh.vertices[5, 0] = value
    good = node("good", box(1, 1, 1), 0)
    shown = scene([good], [matte("#ffffff")], camera=from_above(4))
    bad = Node("bad", "item", (Primitive(mesh, 0),), (0.0, 0.0, 0.0), UPRIGHT, {})
    with pytest.raises(ValueError, match="'bad'"):
        draft(replace(shown, nodes=(*shown.nodes, bad)))
