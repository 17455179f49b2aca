"""Scenes as batches: moved, sorted and merged, with nothing lost."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.output.draft_scene import (
    CONTACT_REACHES,
    DraftScene,
    Normalization,
    draft_scene,
)
from app.scene.scene import Node, Primitive, Scene
from tests.output.scenes import UPRIGHT, box, from_above, linear, matte, node, scene, still_life

SUN = np.array([0.0, 0.6, 0.8])


def draft(shown: Scene, sun: np.ndarray | None = SUN) -> DraftScene:
    return draft_scene(shown, Normalization.of(shown), sun)


def test_every_triangle_is_in_a_batch() -> None:
    shown = still_life()
    drawn = sum(len(batch.faces) for batch in draft(shown).casters)
    assert drawn == sum(
        len(primitive.mesh.faces)
        for part in shown.nodes
        if part.shows != "ground"
        for primitive in part.primitives
    )


def test_opaque_nodes_of_one_kind_make_one_batch() -> None:
    drawn = draft(still_life())
    assert (len(drawn.items), len(drawn.hyperedges), len(drawn.translucent)) == (1, 1, 1)


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
    batch = draft(shown).items[0]
    found = {tuple(row) for row in np.round(batch.positions @ np.eye(3), 4)}
    wanted = np.round(move.points(rotation.apply(mesh.vertices) + at), 4)
    for corner in wanted:
        assert min(np.abs(np.array(list(found)) - corner).max(axis=1)) < 1e-3
    assert np.linalg.norm(batch.normals, axis=1) == pytest.approx(1.0, abs=1e-5)


def test_colors_and_surfaces_are_those_of_the_material() -> None:
    batch = draft(scene([node("one", box(1, 1, 1), 0)], [matte("#d55e00")])).items[0]
    np.testing.assert_allclose(batch.colors, [(*linear("#d55e00"), 1.0)] * 24, rtol=1e-6)
    np.testing.assert_allclose(batch.surfaces, [(0.0, 0.9)] * 24, rtol=1e-6)


def test_what_stands_in_a_tray_is_drawn_before_the_tray_and_glass_the_other_way() -> None:
    tray, content = (
        node("tray", box(4, 4, 0.2), 0),
        node("content", box(1, 1, 1), 1, (0.0, 0.0, 0.6)),
    )
    solid = draft(scene([tray, content], [matte("#ff0000"), matte("#00ff00")])).items[0]
    glass = draft(scene([tray, content], [matte("#ff0000", 0.5), matte("#00ff00", 0.5)]))
    assert solid.colors[0, 1] > solid.colors[-1, 1]
    assert glass.translucent[0].colors[0, 1] < glass.translucent[0].colors[-1, 1]


def test_the_catcher_holds_the_whole_shadow_and_lies_on_the_ground() -> None:
    drawn = draft(scene([node("cube", box(1, 1, 1), 0, (0.0, 0.0, 0.5))], [matte("#ffffff")]))
    corners = drawn.catcher[0].positions
    assert drawn.ground is not None
    np.testing.assert_allclose(corners[:, 2], drawn.ground)
    size = np.sqrt(3.0)
    reach = CONTACT_REACHES * drawn.reach
    shadow_end = (-0.5 - 0.6 / 0.8) / size  # the sun stands to the north
    assert corners[:, 1].min() == pytest.approx(shadow_end - reach, rel=1e-5)
    assert corners[:, 1].max() == pytest.approx(0.5 / size + reach, rel=1e-5)


def test_without_a_ground_there_is_no_catcher() -> None:
    shown = scene([node("cube", box(1, 1, 1), 0)], [matte("#ffffff")], ground=False)
    assert draft(shown).catcher == ()


def test_an_empty_scene_has_no_bounds() -> None:
    drawn = draft(scene([], [matte("#ffffff")]))
    assert drawn.bounds is None
    assert drawn.batches == ()


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
    spoilt = Scene(
        shown.name,
        (*shown.nodes, bad),
        shown.materials,
        shown.lights,
        shown.camera,
        shown.background,
        shown.bounds,
    )
    with pytest.raises(ValueError, match="'bad'"):
        draft(spoilt)
