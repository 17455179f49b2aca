from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.scene.grain import ACROSS, ALONG, VARIANTS, textured, textured_tubes, variant_of
from app.scene.scene import TextureName
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Arrow, Box, Cone, Cylinder, Solid, Sphere, Text, Tray

SOLIDS: tuple[Solid, ...] = (
    Box((1.0, 1.0, 1.0), 0.05),
    Box((0.4, 0.5, 3.0), 0.05),
    Box((20.0, 14.0, 0.5), 0.05),
    Tray((2.0, 1.5, 0.5), 0.1, 0.1),
    Cylinder(0.5, 1.0, 0.05),
    Cone(0.5, 1.0),
    Arrow(2.0, 0.4),
    Sphere(0.5),
    Text("Rg", 0.5, 0.2),
)
each_solid = pytest.mark.parametrize("solid", SOLIDS, ids=lambda solid: type(solid).__name__)
each_texture = pytest.mark.parametrize("texture", ["wood", "stone"])


def coordinates(mesh: Mesh) -> Floats:
    assert mesh.coordinates is not None
    return mesh.coordinates.astype(np.float64)


def stretches(mesh: Mesh, scale: Floats) -> Floats:
    """The smaller and the larger factor by which each face of a mesh grows in the texture."""
    a, b, c = mesh.vertices.astype(np.float64)[mesh.faces].transpose(1, 0, 2)
    x = b - a
    length = np.linalg.norm(x, axis=1)
    along = ((c - a) * x).sum(axis=1) / length
    height = np.linalg.norm(np.cross(x, c - a), axis=1) / length
    is_thick = height > 1e-3 * length
    u, v, w = (coordinates(mesh) * scale)[mesh.faces].transpose(1, 0, 2)
    first = (v - u) / length[:, None]
    second = (w - u - along[:, None] * first) / height[:, None]
    found = np.linalg.svd(np.stack([first, second], axis=-1)[is_thick], compute_uv=False)
    return np.asarray(found[:, ::-1])


@each_solid
@each_texture
def test_textured_solids_look_as_before(solid: Solid, texture: TextureName) -> None:
    mesh = mesh_of(solid)
    found = textured(mesh, texture)
    assert found.bounds == pytest.approx(mesh.bounds)
    assert found.vertices.dtype == found.normals.dtype == np.float32
    assert found.faces.dtype == np.uint32
    assert coordinates(found).shape == (len(found.vertices), 2)
    assert np.isfinite(coordinates(found)).all()
    assert len(found.vertices) < 3000
    assert mesh.coordinates is None, "the mesh that others share is left as it was"


@each_solid
def test_wood_has_no_seams(solid: Solid) -> None:
    """Vertices at one place are at one place of the texture, whatever faces they are of."""
    found = textured(mesh_of(solid), "wood")
    _, which = np.unique(found.vertices, axis=0, return_inverse=True)
    count = which.max() + 1
    for column in coordinates(found).T:
        means = np.bincount(which.ravel(), column, count) / np.bincount(which.ravel())
        assert np.abs(column - means[which.ravel()]).max() < 1e-5


def grain(size: tuple[float, float, float], along: int) -> Floats:
    """How far it is in the texture from one end of a sharp box to the other, by its corners."""
    found = textured(mesh_of(Box(size, 0.0)), "wood")
    is_corner = np.isclose(np.abs(found.vertices), np.array(size) / 2).all(axis=1)
    places, first = np.unique(found.vertices[is_corner], axis=0, return_index=True)
    assert len(places) == 8
    corners = coordinates(found)[is_corner][first]
    is_far = places[:, along] > 0
    return np.asarray(corners[is_far].mean(axis=0) - corners[~is_far].mean(axis=0))


def test_the_grain_of_wood_runs_along_the_longest_side() -> None:
    for along, size in enumerate([(3.0, 0.5, 0.4), (0.4, 3.0, 0.5), (0.4, 0.5, 3.0)]):
        assert grain(size, along) == pytest.approx([3 / ALONG, 0], abs=1e-5)


def test_a_cubes_grain_lies() -> None:
    assert grain((1.0, 1.0, 1.0), 0) == pytest.approx([1 / ALONG, 0], abs=1e-5)


@each_solid
def test_the_rings_of_wood_are_seldom_drawn_out(solid: Solid) -> None:
    """They are where a surface lies along a ring; no flat side does."""
    mesh = textured(mesh_of(solid), "wood")
    found = stretches(mesh, np.array([ALONG, ACROSS]))
    assert found[:, 1].min() > 0.999, "somewhere it is as wide as in the texture"
    assert found[:, 1].max() < 6, "and the slide makes it no smaller than this"
    corners = mesh.vertices.astype(np.float64)[mesh.faces]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    if len(areas) == len(found):
        drawn_out = areas[found.prod(axis=1) < 0.3].sum() / areas.sum()
        assert drawn_out < (0.1 if isinstance(solid, Box | Tray) else 0.15)


@each_solid
def test_speckles_of_stone_are_never_stretched_by_more_than_a_root_of_three(solid: Solid) -> None:
    found = stretches(textured(mesh_of(solid), "stone"), np.array([1.5, 1.5]))
    assert found[:, 1].max() < 1.001
    assert found[:, 0].min() > 0.999 / np.sqrt(3)


def test_rings_at_the_end_of_a_beam_are_arcs() -> None:
    found = textured(mesh_of(Box((3.0, 1.0, 1.0), 0.0)), "wood")
    end = np.isclose(found.vertices[:, 0], 1.5)
    y, z = found.vertices[end, 1:].T
    radius = coordinates(found)[end, 1] * ACROSS
    # Of a circle around a heart: square is linear in place, but for the square of it.
    terms = np.column_stack([y, z, np.ones_like(y), radius - radius.mean()])
    target = radius**2 - y**2 - z**2
    fitted = terms @ np.linalg.lstsq(terms, target, rcond=None)[0]
    assert np.abs(fitted - target).max() < 1e-3


def test_neighbours_are_cut_from_different_places() -> None:
    mesh = mesh_of(Box((1.0, 1.0, 1.0), 0.05))
    for texture in ("wood", "stone"):
        cuts = [coordinates(textured(mesh, texture, variant)) % 1 for variant in range(VARIANTS)]
        for number, cut in enumerate(cuts):
            for other in cuts[:number]:
                gap = np.abs(cut - other).max(axis=0)
                assert gap.min() > 0.05
    assert {variant_of(f"item {number}") for number in range(40)} == set(range(VARIANTS))
    assert variant_of("Größe") == variant_of("Größe")


def test_nothing_stays_nothing() -> None:
    nothing = Mesh.none()
    assert textured(nothing, "wood") is nothing
    assert textured_tubes(nothing, "wood", 0.1).coordinates is None


def test_flat_and_pointed_meshes_get_finite_coordinates() -> None:
    for vertices in (
        [[0, 0, 0]] * 3,
        [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
    ):
        mesh = Mesh(
            np.array(vertices, dtype=np.float32),
            np.tile(np.array([0, 0, 1], dtype=np.float32), (3, 1)),
            np.array([[0, 1, 2]], dtype=np.uint32),
        )
        for texture in ("wood", "stone"):
            assert np.isfinite(coordinates(textured(mesh, texture))).all()


def test_what_is_not_made_of_rings_is_textured_like_a_solid() -> None:
    mesh = mesh_of(Text("tube", 0.3, 0.1))
    found = textured_tubes(mesh, "wood", 0.1, 1)
    assert np.array_equal(coordinates(found), coordinates(textured(mesh, "wood", 1)))
