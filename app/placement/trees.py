"""Trees of constructive solid geometry: from the document's parts within parts to one frame."""

from __future__ import annotations

from app.placement.turning import (
    UNTURNED,
    Quaternion,
    Vector,
    from_degrees,
    then,
    turned,
    turning_up_to,
)
from app.program import csg
from app.solids.csg_tree import Leaf, Operation, Tree


def tree_of(
    node: csg.CsgNode, turn: Quaternion = UNTURNED, origin: Vector = (0.0, 0.0, 0.0)
) -> Tree:
    """``node`` with all its leaves in one frame, in which it is turned and its origin placed."""
    if node.position is not None:
        x, y, z = turned(turn, node.position)
        origin = (origin[0] + x, origin[1] + y, origin[2] + z)
    if node.rotation is not None:
        turn = then(turn, from_degrees(*node.rotation))
    match node:
        case csg.CsgBox(size=size):
            return Leaf("box", size, turn, origin)
        case csg.CsgCylinder(radius=radius, height=height):
            return Leaf("cylinder", (radius, height), turn, origin)
        case csg.CsgCone(radius=radius, height=height, top_radius=top):
            return Leaf("cone", (radius, height, top or 0.0), turn, origin)
        case csg.CsgSphere(radius=radius):
            return Leaf("sphere", (radius,), turn, origin)
        case csg.CsgHalfSpace(normal=normal, offset=offset):
            return Leaf("half_space", (offset,), then(turn, turning_up_to(normal)), origin)
        case _:
            parts = tuple(tree_of(part, turn, origin) for part in node.of)
            return Operation(node.type, parts)
