"""Round and free bodies as faces: their smooth parts, in tones that follow the light."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from manifold3d import CrossSection, FillRule
from numba import njit

from app.arrays import Floats, Indices
from app.output.svg_faces import Face
from app.output.svg_projection import Projection
from app.output.svg_shades import LEVELS, Shades
from app.solids.mesh import Mesh

MANY = 60
"""Bodies from which on each has one light and one dark tone only."""

SPECK = 0.3
"""Square pixels: smaller parts of a tone are left out."""


def surface_faces(
    owner: int,
    mesh: Mesh,
    place: tuple[Floats, Floats],
    shades: Shades,
    many: bool,
    view: Projection,
) -> list[Face]:
    """What is to be seen of a body: one face for each smooth part of its surface.

    ``place`` is its turn (3, 3) and its centre (3,).
    """
    turn, center = place
    seen = view.seen(mesh.vertices @ turn.T + center)
    corners = seen[mesh.faces.astype(np.int64)]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    # y points down: what is counter-clockwise outside is clockwise here.
    front = np.flatnonzero(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < -1e-9)
    if len(front) == 0:
        return []
    faces = mesh.faces[front].astype(np.int64)
    brightness = Shades.brightness(mesh.normals @ turn.T)
    parts = _parts(_welded(mesh)[faces], len(seen))
    order = np.argsort(parts, kind="stable")
    begins = np.flatnonzero(np.diff(parts[order], prepend=-1))
    levels = LEVELS[1:2] if many else LEVELS
    return [
        _face(owner, faces[rows], seen, brightness, shades, levels)
        for rows in np.split(order, begins[1:])
    ]


def _face(
    owner: int,
    faces: Indices,
    seen: Floats,
    brightness: Floats,
    shades: Shades,
    levels: Sequence[float],
) -> Face:
    bright = brightness[faces]
    low, high = float(bright.min()), float(bright.max())
    outline = _united(list(seen[faces][..., :2]))
    triangles = seen[faces]
    inside = [level for level in levels if low < level < high] if shades.is_lit else []
    if high - low < 0.05:
        inside = []
    bounds = [low, *inside, high]
    tones = [
        (
            shades.tone((bounds[number + 1] + bounds[number + 2]) / 2),
            _united(_above(triangles, bright, level)),
        )
        for number, level in enumerate(inside)
    ]
    return Face(owner, outline, shades.tone((low + bounds[1]) / 2), triangles, None, tones)


def _above(triangles: Floats, bright: Floats, level: float) -> list[Floats]:
    """The parts (k, 2) of triangles that are at least so bright."""
    above = bright >= level
    count = above.sum(axis=1)
    parts = list(triangles[count == 3][..., :2])
    for number in (1, 2):
        rows = np.flatnonzero(count == number)
        # Turned so that the corner that is alone comes first.
        alone = np.argmax(above[rows] == (number == 1), axis=1)
        turns = (alone[:, None] + np.arange(3)) % 3
        own = triangles[rows[:, None], turns][..., :2]
        light = bright[rows[:, None], turns]
        share = (level - light[:, :1]) / (light[:, 1:] - light[:, :1])
        cuts = own[:, :1] + share[..., None] * (own[:, 1:] - own[:, :1])
        if number == 1:
            parts += list(np.stack([own[:, 0], cuts[:, 0], cuts[:, 1]], axis=1))
        else:
            parts += list(np.stack([cuts[:, 0], own[:, 1], own[:, 2], cuts[:, 1]], axis=1))
    return parts


def _united(parts: Sequence[Floats]) -> list[Floats]:
    """All parts as one: its contours, but for specks."""
    # Clipper counts turns, which are negative here: y points down.
    united = CrossSection([part[::-1] for part in parts], FillRule.NonZero).simplify(0.02)
    return [ring for ring in united.to_polygons() if abs(area(ring)) > SPECK]


def area(ring: Floats) -> float:
    """The area within a contour (k, 2), negative for one that turns the other way."""
    x, y = ring[:, 0], ring[:, 1]
    last = x[-1] * y[0] - y[-1] * x[0]
    return float(x[:-1] @ y[1:] - y[:-1] @ x[1:] + last) / 2


def _welded(mesh: Mesh) -> Indices:
    """Vertices (v,) by the first one at the same place with nearly the same normal."""
    reach = max(float(np.abs(mesh.vertices).max()), 1e-9)
    keys = np.rint(np.hstack([mesh.vertices * (2e4 / reach), mesh.normals * 6 + 0.137]))
    _, firsts, numbers = np.unique(
        keys.astype(np.int32).view(np.dtype((np.void, 24))).ravel(),
        return_index=True,
        return_inverse=True,
    )
    return firsts[numbers]


@njit(cache=True)
def _parts(faces: Indices, vertices: int) -> Indices:
    """Which part of a surface each face (f, 3) belongs to: those that share a vertex are one."""
    root = np.arange(vertices)
    for face in range(len(faces)):
        first = faces[face, 0]
        while root[first] != first:
            root[first] = root[root[first]]
            first = root[first]
        for corner in range(1, 3):
            other = faces[face, corner]
            while root[other] != other:
                root[other] = root[root[other]]
                other = root[other]
            if other < first:
                root[first] = other
                first = other
            else:
                root[other] = first
    found = np.empty(len(faces), np.int64)
    for face in range(len(faces)):
        vertex = faces[face, 0]
        while root[vertex] != vertex:
            vertex = root[vertex]
        found[face] = vertex
    return found
