"""Triangles with normals: what solids and tubes become."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Faces, Floats, Singles


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles.

    ``vertices`` (v, 3) and unit ``normals`` (v, 3) are float32, ``faces`` (f, 3) uint32 with
    corners counter-clockwise seen from outside. ``coordinates`` (v, 2) float32 are places in a
    texture that repeats with every whole number, where the surface has one.
    """

    vertices: Singles
    normals: Singles
    faces: Faces
    coordinates: Singles | None = None

    @property
    def bounds(self) -> Floats:
        """Smallest and largest corner, (2, 3); the origin twice where there are no triangles."""
        if len(self.vertices) == 0:
            return np.zeros((2, 3))
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)], dtype=np.float64)

    @staticmethod
    def none() -> Mesh:
        """Nothing to see."""
        nothing = np.zeros((0, 3), dtype=np.float32)
        return Mesh(nothing, nothing, np.zeros((0, 3), dtype=np.uint32))
