"""Glyphs as solids, each made once and kept."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from manifold3d import triangulate

from app.arrays import Faces, Floats, Indices, Singles
from app.solids.fonts import typefaces
from app.solids.outlines import polygons

CREASE = np.radians(40.0)
"""Walls that meet at a smaller angle are one smooth wall; flattened curves turn by 30 degrees."""


@dataclass(frozen=True, slots=True, eq=False)
class Glyph:
    """An extruded glyph on the baseline, a capital being 1 high, from z = -1 to 1.

    ``bounds`` (2, 2) are its lowest and highest x and y, ``None`` where there is no ink.
    """

    vertices: Floats
    normals: Singles
    faces: Faces
    bounds: Floats | None


@lru_cache(maxsize=4096)
def glyph(typeface: int, number: int) -> Glyph:
    """Glyph ``number`` of a typeface, given by its place in `typefaces`."""
    face = typefaces()[typeface]
    rings = polygons(face.font, number, face.capital)
    if not rings:
        nothing = np.zeros((0, 3))
        return Glyph(nothing, nothing.astype(np.float32), nothing.astype(np.uint32), None)
    points = np.concatenate(rings)
    walls, wall_normals, wall_faces = _walls(points, _following(rings))
    cap = np.asarray(triangulate(rings), dtype=np.int64)
    n = len(points)
    up = np.tile([0.0, 0.0, 1.0], (n, 1))
    return Glyph(
        np.concatenate([_at(points, 1.0), _at(points, -1.0), walls]),
        np.concatenate([up, -up, wall_normals]).astype(np.float32),
        np.concatenate([cap, cap[:, ::-1] + n, wall_faces + 2 * n]).astype(np.uint32),
        np.array([points.min(axis=0), points.max(axis=0)]),
    )


def _following(rings: list[Floats]) -> Indices:
    """The number of the point that follows each point on its ring."""
    sizes = np.array([len(ring) for ring in rings])
    ends = np.cumsum(sizes)
    following = np.arange(1, ends[-1] + 1)
    following[ends - 1] = ends - sizes
    return following


def _walls(points: Floats, following: Indices) -> tuple[Floats, Floats, Indices]:
    """Upright walls along all rings: vertices (w, 3), normals (w, 3), faces (2n, 3).

    A corner that turns less than CREASE has one normal, the mean of its walls' by their lengths, so
    that a stem stays flat up to where a curve begins; a sharper one has two vertices.
    """
    n = len(points)
    along = points[following] - points
    outward = np.column_stack([along[:, 1], -along[:, 0]])
    flat = _unit(outward)
    preceding = np.empty_like(following)
    preceding[following] = np.arange(n)
    sharp = np.einsum("ij,ij->i", flat, flat[preceding]) < np.cos(CREASE)
    normals = np.where(sharp[:, None], flat, _unit(outward + outward[preceding]))
    arriving = np.flatnonzero(sharp)
    last = np.arange(n)
    last[arriving] = n + np.arange(len(arriving))
    base = np.concatenate([points, points[arriving]])
    sides = np.concatenate([normals, flat[preceding[arriving]]])
    level = len(base)
    start, end = np.arange(n), last[following]
    faces = np.concatenate(
        [
            np.column_stack([start + level, end + level, end]),
            np.column_stack([start + level, end, start]),
        ]
    )
    sideways = np.column_stack([sides, np.zeros(level)])
    return (
        np.concatenate([_at(base, 1.0), _at(base, -1.0)]),
        np.concatenate([sideways, sideways]),
        faces,
    )


def _at(points: Floats, z: float) -> Floats:
    return np.column_stack([points, np.full(len(points), z)])


def _unit(vectors: Floats) -> Floats:
    unit: Floats = vectors / np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
    return unit
