"""How much room a solid takes, without making its mesh."""

from __future__ import annotations

from typing import assert_never

from app.solids.lettering import extent
from app.solids.solid import Arrow, Box, Cone, Csg, Cylinder, Size, Solid, Sphere, Text, Tray


def size_of(solid: Solid) -> Size:
    """Size of the box around ``solid`` in its own axes; its centre is the origin.

    >>> size_of(Arrow(length=3.0, radius=0.5))
    (3.0, 1.0, 1.0)
    """
    match solid:
        case Box(size=size) | Tray(size=size) | Csg(size=size):
            return size
        case Sphere(radius=radius):
            return (2 * radius, 2 * radius, 2 * radius)
        case Cylinder(radius=radius, height=height) | Cone(radius=radius, height=height):
            return (2 * radius, 2 * radius, height)
        case Arrow(length=length, radius=radius):
            return (length, 2 * radius, 2 * radius)
        case Text(text=text, height=height, depth=depth):
            room = extent(text, height)
            return (room.width, room.top - room.bottom, depth if room.width else 0.0)
        case _:
            assert_never(solid)


def middle_of(solid: Solid) -> Size:
    """Where the centre of ``solid`` is, seen from the origin that its document gave it."""
    return solid.middle if isinstance(solid, Csg) else (0.0, 0.0, 0.0)
