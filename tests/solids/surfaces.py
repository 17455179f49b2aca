"""What any solid's surface must be, asked of a mesh by the tests of this room."""

from __future__ import annotations

import numpy as np
import trimesh

from app.arrays import Floats
from app.solids.mesh import Mesh


def welded(mesh: Mesh) -> trimesh.Trimesh:
    """``mesh`` with vertices at one place made one, whatever their normals."""
    places, numbers = np.unique(mesh.vertices, axis=0, return_inverse=True)
    return trimesh.Trimesh(places.astype(np.float64), numbers[mesh.faces], process=False)


def assert_closed(mesh: Mesh) -> None:
    """Every edge belongs to two triangles that agree on what is outside."""
    surface = welded(mesh)
    assert surface.is_watertight
    assert surface.is_winding_consistent
    assert surface.volume > 0


def assert_sound(mesh: Mesh) -> None:
    """Types, finite numbers, unit normals, every vertex used."""
    kinds = [str(array.dtype) for array in (mesh.vertices, mesh.normals, mesh.faces)]
    assert kinds == ["float32", "float32", "uint32"]
    assert np.isfinite(mesh.vertices).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-6)
    np.testing.assert_array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))


def encloses(mesh: Mesh, place: tuple[float, float, float]) -> bool:
    """Whether ``place`` is inside, by the solid angle of all triangles seen from there.

    Formula of van Oosterom and Strackee, The Solid Angle of a Plane Triangle (1983).
    """
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces].astype(np.float64) - place, 1, 0)
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a)))
    angles = 2 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return bool(round(angles.sum() / (4 * np.pi)) == 1)


def largest_deviation(mesh: Mesh) -> float:
    """Largest angle (radians) between a triangle and the normals at its corners."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    across: Floats = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    area = np.linalg.norm(across, axis=1)
    # A needle has slivers whose direction single precision cannot hold.
    broad = area > 1e-4 * longest**2
    facing = across[broad] / area[broad][:, None]
    cosine = np.einsum("fi,fci->fc", facing, mesh.normals[mesh.faces[broad]])
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)).max())
