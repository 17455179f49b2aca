"""What these tests ask of triangles."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.solids.mesh import Mesh


def boundary_edges(mesh: Mesh) -> int:
    """Edges of one face only, once vertices at exactly equal positions are one vertex."""
    _, weld = np.unique(mesh.vertices, axis=0, return_inverse=True)
    faces = weld[mesh.faces]
    distinct = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    edges = np.sort(
        np.concatenate([faces[distinct][:, [i, (i + 1) % 3]] for i in range(3)]), axis=1
    )
    _, counts = np.unique(edges, axis=0, return_counts=True)
    return int(np.count_nonzero(counts == 1))


def facet_normals(mesh: Mesh) -> tuple[Floats, Indices]:
    """Unit normals of the faces that have an area, and which faces these are."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]].astype(np.float64) for k in range(3))
    crossed = np.cross(b - a, c - a)
    lengths = np.linalg.norm(crossed, axis=1)
    solid = np.flatnonzero(lengths > 1e-9)
    return crossed[solid] / lengths[solid, None], solid


def facet_samples(mesh: Mesh) -> Floats:
    """Points inside the facets and on their edges, where a mesh is farthest from its tube."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    weights = np.array(
        [[1, 1, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1], [2, 1, 1], [1, 2, 1], [1, 1, 2]], dtype=float
    )
    weights /= weights.sum(axis=1, keepdims=True)
    return np.asarray(np.einsum("wk,fkx->fwx", weights, corners).reshape(-1, 3))
