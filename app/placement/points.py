"""Attachment points: where on an item a hyperedge may end."""

from __future__ import annotations

import math

from app.placement.turning import Vector
from app.program.model import Item
from app.solids.extents import middle_of
from app.solids.solid import Csg, Size, Solid, Tray

UP: Vector = (0.0, 0.0, 1.0)


def default_point(solid: Solid, size: Size) -> Vector:
    """The middle of the top face, in the item's own axes.

    A tray's top face is its rim: there it is the middle of the rim of the back wall, so that the
    tube does not spear what lies in the tray. What was made of simple solids says itself.
    """
    if isinstance(solid, Tray):
        return (0.0, (size[1] - solid.wall) / 2, size[2] / 2)
    return solid.top if isinstance(solid, Csg) else (0.0, 0.0, size[2] / 2)


def points_of(item: Item, solid: Solid, size: Size) -> dict[str | None, tuple[Vector, Vector]]:
    """Position and unit direction of each attachment point, ``None`` naming the default one.

    They are relative to the solid's centre.
    """
    points: dict[str | None, tuple[Vector, Vector]] = {None: (default_point(solid, size), UP)}
    a, b, c = middle_of(solid)
    for point in item.attachment_points:
        x, y, z = point.direction
        largest = max(abs(x), abs(y), abs(z))
        x, y, z = x / largest, y / largest, z / largest
        length = math.hypot(x, y, z)
        i, j, k = point.position
        points[point.id] = ((i - a, j - b, k - c), (x / length, y / length, z / length))
    return points
