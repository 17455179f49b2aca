"""What of an item is drawn: faces that the camera sees, each one tone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import manifold3d
import numpy as np

from app.arrays import Faces, Floats
from app.output.projection import Projection
from app.solids.meshing import mesh_of
from app.solids.solid import Box, Solid, Tray

TONES = 5
"""Of round things; more would look like a photograph of one."""

LIGHT = np.array([-0.35, -0.45, 0.82])
"""Toward the light: from above, the left and the front, in the world."""


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """Rings of pixels, each (p, 2), and how light they are, 0 to 1.

    ``covers`` says that it is in front of what the item contains.
    """

    rings: tuple[Floats, ...]
    light: float
    covers: bool = False


def faces_of(solid: Solid, rotation: Floats, center: Floats, projection: Projection) -> list[Face]:
    """Faces of a solid that is turned by ``rotation`` (3, 3) and stands at ``center`` (3,)."""
    match solid:
        case Box(size=size):
            corners = _box(np.zeros(3), np.array(size))
            return list(_flat(corners, rotation, center, projection, covers=False))
        case Tray():
            return list(_tray(solid, rotation, center, projection))
        case _:
            return list(_round(solid, rotation, center, projection))


def _flat(
    quads: Floats, rotation: Floats, center: Floats, projection: Projection, *, covers: bool
) -> Iterator[Face]:
    """Quadrilaterals (q, 4, 3) that face the camera."""
    world = quads @ rotation.T + center
    normals = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    front = projection.sees_front(world.mean(axis=1), normals) > 1e-9
    for ring, light in zip(projection(world[front])[..., :2], _light(normals[front]), strict=True):
        yield Face((ring,), float(light), covers)


def _tray(tray: Tray, rotation: Floats, center: Floats, projection: Projection) -> Iterator[Face]:
    """Floor and inner walls, then the walls that stand before the contents."""
    size = np.array(tray.size)
    inner = np.array([size[0] - 2 * tray.wall, size[1] - 2 * tray.wall, size[2] - tray.floor])
    middle = np.array([0.0, 0.0, tray.floor / 2])
    outside, inside = _box(np.zeros(3), size), _box(middle, inner)[:, ::-1]
    # Of the box inside, its top is open; of the one outside, a rim is left.
    yield from _flat(inside[:5], rotation, center, projection, covers=False)
    walls = outside[1:5]
    world = walls @ rotation.T + center
    normals = np.cross(world[:, 1] - world[:, 0], world[:, 2] - world[:, 0])
    before = projection.sees_front(world.mean(axis=1), normals) > 0
    rim = _rim(size, inner)
    yield from _flat(rim[~before], rotation, center, projection, covers=False)
    yield from _flat(rim[before], rotation, center, projection, covers=True)
    yield from _flat(outside[:5], rotation, center, projection, covers=True)


def _round(
    solid: Solid, rotation: Floats, center: Floats, projection: Projection
) -> Iterator[Face]:
    mesh = mesh_of(solid)
    world = mesh.vertices @ rotation.T + center
    corners = world[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals /= np.maximum(lengths, 1e-12)[:, None]
    front = (projection.sees_front(corners.mean(axis=1), normals) > 0) & (lengths > 1e-12)
    tones = np.round(_light(normals) * TONES).astype(np.int64)
    seen = projection(world)[:, :2]
    yield Face(_united(seen, mesh.faces[front]), float(tones[front].min(initial=0)) / TONES)
    for tone in sorted(set(tones[front].tolist()))[1:]:
        rings = _united(seen, mesh.faces[front & (tones == tone)])
        yield Face(rings, tone / TONES)


def _united(seen: Floats, faces: Faces) -> tuple[Floats, ...]:
    """The outline of triangles in the picture."""
    triangles = seen[faces]
    one, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    turn = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    triangles = np.where((turn < 0)[:, None, None], triangles[:, ::-1], triangles)
    united = manifold3d.CrossSection(list(triangles), manifold3d.FillRule.NonZero)
    return tuple(np.asarray(ring) for ring in united.simplify(0.05).to_polygons())


def _light(normals: Floats) -> Floats:
    """How light a surface is, 0 to 1: wrapped around, so that nothing is black."""
    return np.asarray(0.5 + 0.5 * (normals @ (LIGHT / np.linalg.norm(LIGHT))))


def _box(middle: Floats, size: Floats) -> Floats:
    """Six faces (6, 4, 3) counter-clockwise from outside: below, around from the front, above."""
    return np.asarray(_UNIT * size / 2 + middle)


def _rim(size: Floats, inner: Floats) -> Floats:
    top = size[2] / 2
    signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    outer = np.column_stack([signs * size[:2] / 2, np.full(4, top)])
    within = np.column_stack([signs * inner[:2] / 2, np.full(4, top)])
    after = np.roll(np.arange(4), -1)
    return np.stack([outer, outer[after], within[after], within], axis=1)


_UNIT = np.array(
    [
        [[-1, -1, -1], [-1, 1, -1], [1, 1, -1], [1, -1, -1]],
        [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1]],
        [[1, -1, -1], [1, 1, -1], [1, 1, 1], [1, -1, 1]],
        [[1, 1, -1], [-1, 1, -1], [-1, 1, 1], [1, 1, 1]],
        [[-1, 1, -1], [-1, -1, -1], [-1, -1, 1], [-1, 1, 1]],
        [[-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]],
    ],
    dtype=np.float64,
)
