"""Closed surfaces with normals, to and from the library that puts bodies together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from manifold3d import Manifold, Mesh64

from app.arrays import Faces, Floats, Indices, Singles
from app.solids.csg_leaves import doubles_of, leaf_surface
from app.solids.csg_tree import Leaf
from app.solids.welding import part

STEEP = 0.2
"""Cosine between a face and a normal at its corner, below which the normal is none of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Vertices (v, 3) and unit normals (v, 3) in single precision, faces (f, 3).

    It is closed: no two positions that are not one are alike.
    """

    vertices: Singles
    normals: Singles
    faces: Faces


def leaf_body(leaf: Leaf, sides: int, center: Floats, reach: float) -> Manifold:
    """A leaf as a body about ``center``; see `leaf_surface`."""
    vertices, normals, faces = leaf_surface(leaf, sides, center, reach)
    doubles, before = doubles_of(leaf, sides)
    return Manifold(
        Mesh64(
            np.hstack([vertices, normals]),
            faces.astype(np.uint64),
            merge_from_vert=doubles.astype(np.uint64),
            merge_to_vert=before.astype(np.uint64),
        )
    )


def surface_of(body: Manifold) -> Surface | None:
    """The surface of ``body``, whose normals came with its parts; none if it is too thin to hold.

    A surface that bounded what was taken away is seen from its other side.
    """
    mesh = body.to_mesh64()
    properties = np.asarray(mesh.vert_properties, dtype=np.float64)
    faces = np.asarray(mesh.tri_verts, dtype=np.int64)
    same = np.arange(len(properties))
    same[np.asarray(mesh.merge_from_vert, dtype=np.int64)] = mesh.merge_to_vert
    firsts, numbers = np.unique(same, return_inverse=True)
    parted = part(properties[firsts, :3], numbers[faces].astype(np.uint32))
    if parted is None:
        return None
    vertices, normals, faces = _with_normals(properties, faces)
    used, faces = np.unique(faces, return_inverse=True)
    return Surface(
        parted[numbers[vertices[used]]],
        normals[used].astype(np.float32),
        faces.reshape(-1, 3).astype(np.uint32),
    )


def _with_normals(properties: Floats, faces: Indices) -> tuple[Indices, Floats, Indices]:
    """Vertices (w,) by their rows in ``properties``, their unit normals (w, 3), and faces (f, 3).

    Corners whose vertex has no normal for their face get a vertex of their own, and that face's.
    """
    facing, areas = _facing(properties[:, :3], faces)
    normals = properties[:, 3:6]
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    along = np.einsum("fci,fi->fc", normals[faces], facing)
    tally = np.bincount(faces.ravel(), (along * areas[:, None]).ravel(), minlength=len(normals))
    signs = np.where(tally < 0, -1.0, 1.0)
    normals = normals * signs[:, None]
    strange = (along * signs[faces] < STEEP) & (areas > 0)[:, None]
    strange |= ~normals.any(axis=1)[faces]
    rows = faces[strange]
    faces = faces.copy()
    faces[strange] = len(normals) + np.arange(len(rows))
    vertices = np.concatenate([np.arange(len(normals)), rows])
    own = np.repeat(facing[:, None], 3, axis=1)[strange]
    own[~own.any(axis=1)] = (0.0, 0.0, 1.0)
    return vertices, np.concatenate([normals, own]), faces


def _facing(positions: Floats, faces: Indices) -> tuple[Floats, Floats]:
    """Unit normals (f, 3) of faces, zero where one has no area, and twice their areas (f,)."""
    a, b, c = np.moveaxis(positions[faces], 1, 0)
    across = np.cross(b - a, c - a)
    areas = np.linalg.norm(across, axis=1)
    unit = np.divide(across, areas[:, None], out=np.zeros_like(across), where=areas[:, None] > 0)
    return unit, areas
