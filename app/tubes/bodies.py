"""Stretches of tubes as closed bodies, for manifold3d to unite."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from manifold3d import Manifold, Mesh64
from numpy.typing import NDArray

from app.arrays import Floats
from app.tubes.chains import Rings
from app.tubes.circle import latitudes
from app.tubes.stacks import strips, write_faces
from app.tubes.stretches import Stretches


def bodies(rings: Rings, stretches: Stretches, chain: int) -> Iterator[Manifold]:
    """Bodies that together are the tube of one chain, with a half ball at either end.

    Those that follow each other share the ring between them and the half balls on it, to the bit.
    """
    n, radius = rings.sides[chain], float(rings.radii[chain])
    for i in range(stretches.starts[chain], stretches.starts[chain + 1]):
        first, last = stretches.first[i], stretches.last[i]
        start = rings.starts[chain] + first * n
        vertices = rings.vertices[start : start + (last + 1 - first) * n].reshape(-1, n, 3)
        radials = rings.radials[start : start + (last + 1 - first) * n].reshape(-1, n, 3)
        if stretches.open[i]:
            yield _capsule(vertices, radials, radius)
        else:
            yield _hull_of_balls(vertices[[0, -1]], radials[[0, -1]], radius)


def _capsule(vertices: Floats, radials: Floats, radius: float) -> Manifold:
    """A tube through rings (m, n, 3), rounded at both ends."""
    behind = _dome(vertices[0], radials[0], radius, -1.0)
    ahead = _dome(vertices[-1], radials[-1], radius, 1.0)[::-1]
    # A dome begins with its pole, once for each side.
    parts = [behind[0, :1], behind[1:], vertices, ahead[:-1], ahead[-1, :1]]
    points = np.concatenate([part.reshape(-1, 3) for part in parts])
    rows = len(behind) + len(vertices) + len(ahead) - 2
    return Manifold(Mesh64(points, _faces(vertices.shape[1], rows)))


def _hull_of_balls(vertices: Floats, radials: Floats, radius: float) -> Manifold:
    """The hull of balls around two rings (2, n, 3)."""
    domes = [
        _dome(ring, spokes, radius, sense).reshape(-1, 3)
        for ring, spokes in zip(vertices, radials, strict=True)
        for sense in (-1.0, 1.0)
    ]
    return Manifold.hull_points(np.concatenate([vertices.reshape(-1, 3), *domes]))


def _dome(ring: Floats, radials: Floats, radius: float, sense: float) -> Floats:
    """Rows of a half ball on a ring (n, 3), from its pole on, without the ring: (rows, n, 3).

    It stands on the side that the curve goes to where ``sense`` is 1.0, on the other where -1.0.
    """
    n = len(ring)
    tangent = np.cross(radials[0], radials[n // 4])
    tangent *= sense / np.linalg.norm(tangent)
    across, along = latitudes()[n, :, : -(-n // 4) - 1]
    center = ring[0] - radius * radials[0]
    rows = np.concatenate([[0.0], across])[:, None, None] * radials
    rows += np.concatenate([[1.0], along])[:, None, None] * tangent
    return np.asarray(center + radius * rows)


@lru_cache(maxsize=256)
def _faces(sides: int, rows: int) -> NDArray[np.uint64]:
    """Faces (f, 3) of so many rows between two poles."""
    faces = np.empty(3 * 2 * sides * rows, dtype=np.uint32)
    write_faces(strips(), faces, 0, 0, sides, rows, first_pole=True, last_pole=True)
    # Not made read-only, for manifold3d takes no such arrays; it copies them.
    return faces.reshape(-1, 3).astype(np.uint64)
