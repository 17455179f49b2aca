"""Where each vertex of a solid lies in its texture: along the grain of wood, anywhere on stone."""

from __future__ import annotations

from zlib import crc32

import numpy as np

from app.arrays import Floats
from app.scene.refining import refined
from app.scene.scene import TextureName
from app.scene.strands import strands_of
from app.solids.mesh import Mesh

ALONG, ACROSS = 4.5, 1.5
"""Document units that one texture of wood covers along its grain and across."""

SPECKLED = 1.5
"""Document units that one texture of stone covers in both directions."""

VARIANTS = 4
"""Places in the texture that solids may be cut from, so that neighbours are not clones."""

# The heart of the trunk is outside the solid, to the lower front, at this many times half of what
# the solid measures across its grain; so its rings are arcs, and no long face lies along them.
_HEART = np.array([-1.75, -1.15])

# How much the texture slides along the grain for each unit around the trunk. Without, fibres would
# be drawn out around it; so they are cut short on the ends and smeared nowhere.
_SLIDE = 3.0

# Rings are arcs, and triangles straight: so many pieces across the solid keep them round.
_PIECES = 8


def variant_of(name: str) -> int:
    """The place that a thing of this id is cut from."""
    return crc32(name.encode()) % VARIANTS


def textured(mesh: Mesh, texture: TextureName, variant: int = 0) -> Mesh:
    """The same surface with coordinates in ``texture``; some vertices more, where they need it.

    Wood is as if cut from a trunk: all that there is to see is a function of the place alone, so
    it has no seams, and rings that run along its sides come out at its ends. The grain runs along
    the mesh's longest extent, and along x rather than z where it is about as long. Stone has its
    speckles projected along the axis that a triangle faces most, with vertices split where that
    changes: that seam hides among them.
    """
    if len(mesh.faces) == 0:
        return mesh
    return _wooden(mesh, variant) if texture == "wood" else _stony(mesh, variant)


def textured_tubes(mesh: Mesh, texture: TextureName, radius: float, variant: int = 0) -> Mesh:
    """The tubes of one hyperedge, of that ``radius``, with coordinates in ``texture``.

    The grain of wood runs along them, and past joins; it is mirrored from one half of a tube to the
    other, so it has no seam. Where the mesh is not one of tubes, it is as in `textured`.
    """
    strands = strands_of(mesh) if texture == "wood" else None
    if strands is None:
        return textured(mesh, texture, variant)
    u = strands.along / ALONG + 0.37 * variant
    v = strands.around * (np.pi * radius / ACROSS) + 0.29 * variant
    return _with_coordinates(mesh, np.column_stack([u, v]))


def _wooden(mesh: Mesh, variant: int) -> Mesh:
    low, high = mesh.bounds
    extents = high - low
    # As long as another is long enough: x before y before z.
    along = int(np.argmax(extents > 0.8 * extents.max()))
    first, second = ((1, 2), (0, 2), (0, 1))[along]
    across = extents[[first, second]]
    reach = float(np.linalg.norm(across)) or float(extents[along])
    heart = (low + high)[[first, second]] / 2 + _HEART * reach / 2
    mesh = refined(mesh, (first, second), reach / _PIECES)
    from_heart = mesh.vertices[:, [first, second]].astype(np.float64) - heart
    radius = np.hypot(*from_heart.T)
    around = np.arctan2(from_heart[:, 1], from_heart[:, 0]) * np.linalg.norm(_HEART) * reach / 2
    u = (mesh.vertices[:, along] + _SLIDE * around) / ALONG + 0.37 * variant
    v = radius / ACROSS + 0.29 * variant
    return _with_coordinates(mesh, np.column_stack([u, v]))


def _stony(mesh: Mesh, variant: int) -> Mesh:
    """Each face seen along the axis that it faces most, with vertices of its own."""
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axes = np.argmax(np.abs(across), axis=1)
    keys = 3 * mesh.faces.astype(np.int64) + axes[:, None]
    used, faces = np.unique(keys, return_inverse=True)
    found, axis = used // 3, used % 3
    places = mesh.vertices[found].astype(np.float64)
    sideways = np.array([[1, 2], [0, 2], [0, 1]])[axis]
    flat = np.take_along_axis(places, sideways, axis=1) / SPECKLED
    flat += 0.31 * axis[:, None] + 0.27 * variant
    split = Mesh(mesh.vertices[found], mesh.normals[found], faces.reshape(-1, 3).astype(np.uint32))
    return _with_coordinates(split, flat)


def _with_coordinates(mesh: Mesh, coordinates: Floats) -> Mesh:
    """The mesh with them; whole numbers are taken off, which change nothing but cost precision."""
    coordinates = coordinates - np.floor(coordinates.min(axis=0))
    placed = coordinates.astype(np.float32)
    placed.flags.writeable = False
    return Mesh(mesh.vertices, mesh.normals, mesh.faces, placed)
