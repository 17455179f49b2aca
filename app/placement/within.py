"""Places within what contains an item, in the world."""

from __future__ import annotations

from app.placement.turning import Quaternion, Vector, turned
from app.solids.extents import middle_of
from app.solids.solid import Solid


def in_parent(solid: Solid, center: Vector, turn: Quaternion, offset: Vector) -> Vector:
    """Where in the world ``offset`` from the origin of a parent is.

    The parent is a ``solid`` at ``center``, turned by ``turn``.
    """
    x, y, z = middle_of(solid)
    moved = turned(turn, (offset[0] - x, offset[1] - y, offset[2] - z))
    return (center[0] + moved[0], center[1] + moved[1], center[2] + moved[2])
