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


def mesh_of(solid: Solid, coarseness: float = 0.0) -> Mesh:
    """Triangles of ``solid``, closed and with normals; the same arrays each time, read-only.

    Where it is enough that what is round is off by ``coarseness``, there are fewer of them. A blank
    text has no triangles.
    """
    if isinstance(solid, Text) and len(solid.text) > LONGEST_KEPT:
        return _made(solid, 0.0)
    if isinstance(solid, Csg):
        return body_of(solid.tree).mesh
    return _kept(solid, 0.0 if isinstance(solid, Text) else coarseness)


@lru_cache(maxsize=512)
def _kept(solid: Solid, coarseness: float) -> Mesh:
    return _made(solid, coarseness)


def _made(solid: Solid, coarseness: float) -> Mesh:
    mesh = _mesh(solid, coarseness)
    for array in (mesh.vertices, mesh.normals, mesh.faces):
        array.flags.writeable = False
    return mesh


def _mesh(solid: Solid, coarseness: float) -> Mesh:
    match solid:
        case Box() | Tray():
            return block_mesh(solid, coarseness)
        case Sphere() | Cylinder() | Cone() | Arrow():
            return round_mesh(solid, coarseness)
        case Text():
            return text_mesh(solid)
        case Csg():
            return body_of(solid.tree).mesh
        case _:
            assert_never(solid)
