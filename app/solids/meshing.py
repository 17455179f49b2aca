"""The mesh of any solid, made once and kept."""

from __future__ import annotations

from functools import lru_cache
from typing import assert_never

from app.solids.blocks import block_mesh
from app.solids.csg_bodies import body_of
from app.solids.mesh import Mesh
from app.solids.rounds import round_mesh
from app.solids.solid import Arrow, Box, Cone, Csg, Cylinder, Solid, Sphere, Text, Tray
from app.solids.texts import text_mesh

LONGEST_KEPT = 64
"""Characters. The mesh of a longer label takes more memory than making it again takes time."""


def mesh_of(solid: Solid) -> Mesh:
    """Triangles of ``solid``, closed and with normals; the same arrays each time, read-only.

    A blank text has no triangles.
    """
    if isinstance(solid, Text) and len(solid.text) > LONGEST_KEPT:
        return _made(solid)
    if isinstance(solid, Csg):
        return body_of(solid.tree).mesh
    return _kept(solid)


@lru_cache(maxsize=512)
def _kept(solid: Solid) -> Mesh:
    return _made(solid)


def _made(solid: Solid) -> Mesh:
    mesh = _mesh(solid)
    for array in (mesh.vertices, mesh.normals, mesh.faces):
        array.flags.writeable = False
    return mesh


def _mesh(solid: Solid) -> Mesh:
    match solid:
        case Box() | Tray():
            return block_mesh(solid)
        case Sphere() | Cylinder() | Cone() | Arrow():
            return round_mesh(solid)
        case Text():
            return text_mesh(solid)
        case Csg():
            return body_of(solid.tree).mesh
        case _:
            assert_never(solid)
