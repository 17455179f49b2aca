from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from app.arrays import Floats
from app.solids.extents import size_of
from app.solids.meshing import mesh_of
from app.solids.solid import Arrow, Box, Cone, Cylinder, Solid, Sphere, Text, Tray
from tests.solids.surfaces import assert_closed, assert_sound, encloses, largest_deviation, welded

lengths = st.floats(1e-2, 1e4)
edges = st.one_of(st.just(0.0), st.floats(1e-6, 1e5))
sizes = st.tuples(lengths, lengths, lengths)
solids: st.SearchStrategy[Solid] = st.one_of(
    st.builds(Box, sizes, edges),
    st.builds(Tray, sizes, lengths, lengths),
    st.builds(Sphere, lengths),
    st.builds(Cylinder, lengths, lengths, edges),
    st.builds(Cone, lengths, lengths),
    st.builds(Arrow, lengths, lengths),
)

ORDINARY: list[Solid] = [
    Box((2.0, 1.0, 1.0), 0.05),
    Box((2.0, 1.0, 1.0), 0.0),
    Tray((4.0, 3.0, 1.0), 0.15, 0.1),
    Sphere(0.5),
    Cylinder(0.5, 1.0, 0.05),
    Cone(0.5, 1.0),
    Arrow(3.0, 0.3),
    Text("Tree", 0.5, 0.1),
]


@given(solids)
def test_a_solid_of_any_size_is_closed_and_sound(solid: Solid) -> None:
    # Single precision cannot tell a tray's floor from its underside at a millionth of its height.
    assume(not isinstance(solid, Tray) or max(solid.size) < 1e5 * min(solid.floor, solid.wall))
    mesh = mesh_of(solid)
    assert_sound(mesh)
    assert_closed(mesh)


@given(solids, st.floats(1e-6, 1e3))
def test_a_coarse_mesh_is_closed_fills_its_size_and_is_no_finer(
    solid: Solid, coarseness: float
) -> None:
    assume(not isinstance(solid, Tray) or max(solid.size) < 1e5 * min(solid.floor, solid.wall))
    mesh = mesh_of(solid, coarseness)
    assert_sound(mesh)
    assert_closed(mesh)
    half = np.array(size_of(solid)) / 2
    np.testing.assert_allclose(mesh.bounds, [-half, half], rtol=1e-6)
    assert len(mesh.faces) <= len(mesh_of(solid).faces)


@given(st.floats(1e-4, 0.3))
def test_what_is_round_is_off_by_its_coarseness_at_most(coarseness: float) -> None:
    def middles(solid: Solid) -> Floats:
        mesh = mesh_of(solid, coarseness)
        return np.asarray(mesh.vertices[mesh.faces].mean(axis=1, dtype=np.float64))

    # Nothing is finer than usual: a sphere of 32 sides is off by a hundredth of its radius.
    most = max(coarseness, 0.0097)
    assert np.linalg.norm(middles(Sphere(1.0)), axis=1).min() >= 1.0 - most
    places = middles(Cylinder(1.0, 2.0, 0.0))
    assert np.hypot(*places[np.abs(places[:, 2]) < 0.9, :2].T).min() >= 1.0 - most
    # A corner of the box in four steps is as coarse as a ball of sixteen.
    core = np.full(3, 0.5)
    places = middles(Box((2.0, 2.0, 2.0), 0.5))
    outward = np.linalg.norm(places - np.clip(places, -core, core), axis=1)
    assert outward.min() >= 0.5 - max(coarseness, 0.5 * 0.038)


@pytest.mark.parametrize("solid", ORDINARY[:1] + ORDINARY[2:-1], ids=str)
def test_where_it_does_not_show_there_are_fewer_triangles(solid: Solid) -> None:
    assert len(mesh_of(solid, 0.1).faces) < 0.6 * len(mesh_of(solid).faces)
    assert mesh_of(solid, 0.1) is mesh_of(solid, 0.1)


@given(solids)
def test_a_solid_fills_its_size_around_the_origin(solid: Solid) -> None:
    half = np.array(size_of(solid)) / 2
    np.testing.assert_allclose(mesh_of(solid).bounds, [-half, half], rtol=1e-6)


@pytest.mark.parametrize("solid", ORDINARY, ids=str)
def test_normals_follow_the_surface_up_to_a_crease(solid: Solid) -> None:
    assert largest_deviation(mesh_of(solid)) < radians(35)


@given(solids)
def test_no_normal_points_into_its_solid(solid: Solid) -> None:
    assert largest_deviation(mesh_of(solid)) < radians(60)


@given(st.tuples(*[st.floats(0.1, 50.0)] * 3), st.floats(0.0, 0.4))
def test_a_rounded_box_has_the_volume_of_a_box_swept_by_a_ball(
    size: tuple[float, float, float], share: float
) -> None:
    edge = share * min(size)
    x, y, z = (length - 2 * edge for length in size)
    faces, quarters = 2 * edge * (x * y + y * z + z * x), pi * edge**2 * (x + y + z)
    exact = x * y * z + faces + quarters + 4 / 3 * pi * edge**3
    mesh = mesh_of(Box(size, edge))
    # The coarsest polygon has eight sides, and the area of its circle but for a tenth.
    assert 0.9 * exact <= welded(mesh).volume <= 1.0001 * exact


def test_a_box_with_an_edge_beyond_its_half_becomes_a_pebble() -> None:
    pebble = welded(mesh_of(Box((1.0, 1.0, 1.0), 7.0)))
    assert 0.5 < pebble.volume < 0.6


def test_the_flat_sides_of_a_box_shade_flat() -> None:
    mesh = mesh_of(Box((2.0, 2.0, 2.0), 0.1))
    on_top = mesh.faces[np.all(mesh.vertices[mesh.faces][:, :, 2] == 1.0, axis=1)]
    assert len(on_top) == 2
    np.testing.assert_array_equal(mesh.normals[on_top], np.broadcast_to([0, 0, 1], (2, 3, 3)))


def test_normals_on_a_box_are_those_of_the_exact_rounding() -> None:
    mesh = mesh_of(Box((2.0, 3.0, 4.0), 0.25))
    core = np.array([0.75, 1.25, 1.75])
    outward = mesh.vertices - np.clip(mesh.vertices, -core, core)
    np.testing.assert_allclose(mesh.normals, outward / 0.25, atol=1e-6)


def test_a_sharp_box_is_twelve_triangles_with_flat_normals() -> None:
    mesh = mesh_of(Box((1.0, 2.0, 3.0), 0.0))
    assert (len(mesh.faces), len(mesh.vertices)) == (12, 24)
    assert largest_deviation(mesh) < 1e-6


def test_a_tray_holds_what_its_walls_and_floor_leave() -> None:
    mesh = mesh_of(Tray((4.0, 3.0, 1.0), 0.1, 0.2))
    hollow = 3.8 * 2.8 * 0.8
    assert welded(mesh).volume == pytest.approx(4.0 * 3.0 * 1.0 - hollow, rel=0.03)
    assert all(encloses(mesh, place) for place in [(0.0, 0.0, -0.4), (1.95, 0.0, 0.0)])
    outside = [(0.0, 0.0, -0.25), (1.85, 0.0, 0.0), (0.0, 1.35, 0.4)]
    assert not any(encloses(mesh, place) for place in outside)


@pytest.mark.parametrize("wall", [0.4, 1.0, 50.0])
@pytest.mark.parametrize("floor", [0.1, 1.0, 50.0])
def test_a_tray_keeps_a_hollow_however_thick_its_walls(wall: float, floor: float) -> None:
    tray = Tray((1.0, 1.0, 1.0), wall, floor)
    mesh = mesh_of(tray)
    assert_closed(mesh)
    assert not encloses(mesh, (0.0, 0.0, 0.45))


def test_a_sphere_has_its_volume_and_normals_from_its_centre() -> None:
    mesh = mesh_of(Sphere(2.0))
    assert welded(mesh).volume == pytest.approx(4 / 3 * pi * 8, rel=0.02)
    np.testing.assert_allclose(mesh.normals, mesh.vertices / 2, atol=1e-6)


def test_a_cylinder_has_its_volume() -> None:
    assert welded(mesh_of(Cylinder(1.0, 4.0, 0.0))).volume == pytest.approx(4 * pi, rel=0.01)


def test_a_cylinder_is_rounded_at_both_rims() -> None:
    mesh = mesh_of(Cylinder(1.0, 2.0, 0.1))
    across = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    for end in (-1.0, 1.0):
        assert across[mesh.vertices[:, 2] == np.float32(end)].max() == pytest.approx(0.9, abs=1e-6)


def test_a_cone_has_its_volume_and_a_normal_for_each_side_at_its_tip() -> None:
    mesh = mesh_of(Cone(1.0, 2.0))
    assert welded(mesh).volume == pytest.approx(2 / 3 * pi, rel=0.01)
    tip = mesh.vertices[:, 2] == 1.0
    np.testing.assert_allclose(mesh.normals[tip][:, 2], 1 / np.sqrt(5), atol=1e-6)
    sides = mesh.faces[np.any(tip[mesh.faces], axis=1)]
    middle = mesh.vertices[sides].sum(axis=1)[:, :2]
    normal = mesh.normals[sides][tip[sides]][:, :2]
    np.testing.assert_allclose(
        np.arctan2(middle[:, 1], middle[:, 0]), np.arctan2(normal[:, 1], normal[:, 0]), atol=1e-5
    )


def test_an_arrow_points_along_x_with_its_head_in_front() -> None:
    mesh = mesh_of(Arrow(4.0, 0.5))
    np.testing.assert_array_equal(mesh.vertices[mesh.vertices[:, 0] == 2.0][:, 1:], 0.0)
    widest = mesh.vertices[np.hypot(mesh.vertices[:, 1], mesh.vertices[:, 2]) > 0.49]
    np.testing.assert_allclose(widest[:, 0], 2.0 - 1.2, atol=1e-6)


@pytest.mark.parametrize(
    ("solid", "most"),
    [
        (Box((2.0, 1.0, 1.0), 0.05), 108),
        (Tray((4.0, 3.0, 1.0), 0.15, 0.1), 420),
        (Sphere(0.5), 960),
        (Cylinder(0.5, 1.0, 0.05), 384),
        (Cone(0.5, 1.0), 64),
        (Arrow(3.0, 0.3), 320),
        (Text("argument", 0.5, 0.1), 1500),
    ],
    ids=str,
)
def test_a_solid_is_economical(solid: Solid, most: int) -> None:
    assert len(mesh_of(solid).faces) <= most


@pytest.mark.parametrize("solid", ORDINARY, ids=str)
def test_a_mesh_is_made_once_and_cannot_be_changed(solid: Solid) -> None:
    mesh = mesh_of(solid)
    assert mesh_of(solid) is mesh
    for array in (mesh.vertices, mesh.normals, mesh.faces):
        assert not array.flags.writeable
