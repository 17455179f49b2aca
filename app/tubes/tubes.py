"""All tubes of a program as triangles: what the scene takes apart by hyperedge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Faces, Indices, Singles
from app.solids.mesh import Mesh


@dataclass(frozen=True, slots=True, eq=False)
class Tubes:
    """Triangles of h hyperedges, one after another in shared arrays.

    ``vertices``, ``normals`` (v, 3) float32 and ``faces`` (f, 3) uint32; those of hyperedge k are
    ``vertex_starts[k]`` to ``vertex_starts[k + 1]`` and ``face_starts[k]`` to
    ``face_starts[k + 1]``. Faces number the vertices of their own hyperedge from 0.
    """

    vertices: Singles
    normals: Singles
    faces: Faces
    vertex_starts: Indices
    face_starts: Indices

    def mesh(self, hyperedge: int) -> Mesh:
        """The tubes of one hyperedge, as views into the shared arrays."""
        vertices = slice(self.vertex_starts[hyperedge], self.vertex_starts[hyperedge + 1])
        faces = slice(self.face_starts[hyperedge], self.face_starts[hyperedge + 1])
        return Mesh(self.vertices[vertices], self.normals[vertices], self.faces[faces])

    @staticmethod
    def of(meshes: Sequence[Mesh]) -> Tubes:
        """The meshes of h hyperedges, one after another."""
        if not meshes:
            return Tubes.none()
        vertex_starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
        face_starts = np.cumsum([0, *(len(mesh.faces) for mesh in meshes)])
        return Tubes(
            np.concatenate([mesh.vertices for mesh in meshes]),
            np.concatenate([mesh.normals for mesh in meshes]),
            np.concatenate([mesh.faces for mesh in meshes]),
            vertex_starts,
            face_starts,
        )

    @staticmethod
    def none() -> Tubes:
        """The tubes of a program without hyperedges."""
        nothing = np.zeros((0, 3), dtype=np.float32)
        start = np.zeros(1, dtype=np.int64)
        return Tubes(nothing, nothing, np.zeros((0, 3), dtype=np.uint32), start, start)
