from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Singles
from app.scene.refining import refined
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Arrow, Box, Cone, Cylinder, Solid, Sphere, Text, Tray
from app.solids.welding import weld

SOLIDS: tuple[Solid, ...] = (
    Box((3.0, 1.0, 0.4), 0.05),
    Box((1.0, 1.0, 1.0), 0.0),
    Tray((2.0, 1.5, 0.5), 0.1, 0.1),
    Cylinder(0.5, 1.0, 0.05),
    Cone(0.5, 1.0),
    Arrow(2.0, 0.4),
    Sphere(0.5),
    Text("Rg", 0.5, 0.2),
)


def lengths(mesh: Mesh, axes: tuple[int, int]) -> Singles:
    corners = mesh.vertices[mesh.faces][..., list(axes)]
    return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1))


def volume_and_surface(mesh: Mesh) -> tuple[float, float]:
    a, b, c = mesh.vertices.astype(np.float64)[mesh.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    return float((a * normals).sum()) / 6, float(np.linalg.norm(normals, axis=1).sum()) / 2


@pytest.mark.parametrize("solid", SOLIDS, ids=lambda solid: type(solid).__name__)
@pytest.mark.parametrize("axes", [(0, 1), (1, 2)])
def test_refined_solids_are_the_same_closed_surface(solid: Solid, axes: tuple[int, int]) -> None:
    mesh = mesh_of(solid)
    found = refined(mesh, axes, 0.15)
    assert lengths(found, axes).max() <= 0.15
    assert len(found.faces) > len(mesh.faces) or found is mesh
    assert volume_and_surface(found) == pytest.approx(volume_and_surface(mesh), rel=1e-4)
    assert np.linalg.norm(found.normals, axis=1) == pytest.approx(1, abs=1e-5)
    _, faces = weld(found.vertices, found.faces)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = {(int(a), int(b)) for a, b in edges}
    assert len(there) == len(edges)
    assert there == {(b, a) for a, b in there}, "every edge has a neighbour: nothing gapes"


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.05, 2))
def test_any_triangles_keep_their_area_and_their_sides(seed: int, longest: float) -> None:
    generator = np.random.default_rng(seed)
    vertices = generator.random((12, 3)).astype(np.float32)
    faces = generator.permuted(np.tile(np.arange(12), (6, 1)), axis=1)[:, :3].astype(np.uint32)
    normals = np.tile(np.array([0, 0, 1], dtype=np.float32), (12, 1))
    found = refined(Mesh(vertices, normals, faces), (0, 2), longest)
    assert lengths(found, (0, 2)).max() <= longest * (1 + 1e-6)
    corners, before = found.vertices[found.faces], vertices[faces]
    directed = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    whole = np.cross(before[:, 1] - before[:, 0], before[:, 2] - before[:, 0])
    assert directed.sum(axis=0) == pytest.approx(whole.sum(axis=0), abs=1e-4)
    area = np.linalg.norm(whole, axis=1).sum()
    assert np.linalg.norm(directed, axis=1).sum() == pytest.approx(area, rel=1e-3)


def test_a_mesh_fine_enough_is_left_alone() -> None:
    mesh = mesh_of(Box((1.0, 1.0, 1.0), 0.05))
    assert refined(mesh, (0, 1), 2.0) is mesh
