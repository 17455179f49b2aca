"""Sphere, cylinder, cone and arrow: profiles led around a circle."""

from __future__ import annotations

from math import hypot

import numpy as np

from app.solids.lathe import Profile, circle, corner, point, quarters, turn
from app.solids.mesh import Mesh
from app.solids.rounding import rounding
from app.solids.solid import Arrow, Cone, Cylinder, Sphere

SIDES = 32
"""A circle's polygon is then at most half a hundredth of its radius inside it."""

SHAFT = 0.45
"""Radius of an arrow's shaft, of its head's."""

HEAD = 2.4
"""Length of an arrow's head, of its radius, where the arrow is not too short."""


def round_mesh(solid: Sphere | Cylinder | Cone | Arrow) -> Mesh:
    """The mesh of a solid with an axis of revolution."""
    match solid:
        case Sphere():
            return _sphere(solid)
        case Cylinder():
            return _cylinder(solid)
        case Cone():
            return _cone(solid)
        case Arrow():
            return _arrow(solid)


def _sphere(sphere: Sphere) -> Mesh:
    normals = quarters(-1, 2, SIDES // 4)
    return turn(circle(SIDES), np.column_stack([sphere.radius * normals, normals]))


def _cylinder(cylinder: Cylinder) -> Mesh:
    """``edge`` is held below the radius and half the height."""
    radius, z = cylinder.radius, cylinder.height / 2
    edge, segments = rounding(cylinder.edge, limit=2 * min(radius, z), reach=max(radius, z))
    return turn(
        circle(SIDES),
        np.concatenate(
            [
                point(0.0, -z, (0.0, -1.0)),
                corner(radius, -z, -1, edge, segments),
                corner(radius, z, 0, edge, segments),
                point(0.0, z, (0.0, 1.0)),
            ]
        ),
    )


def _cone(cone: Cone) -> Mesh:
    z = cone.height / 2
    profile = [point(0.0, -z, (0.0, -1.0)), _spike(cone.radius, -z, z)]
    return turn(circle(SIDES), np.concatenate(profile))


def _arrow(arrow: Arrow) -> Mesh:
    """A shaft and a head a little longer than wide, or half as long as the arrow if it is short."""
    radius, end = arrow.radius, arrow.length / 2
    neck = end - min(HEAD * radius, end)
    shaft = SHAFT * radius
    edge, segments = rounding(
        0.15 * shaft, limit=min(2 * shaft, neck + end), reach=max(end, radius)
    )
    upright = turn(
        circle(SIDES),
        np.concatenate(
            [
                point(0.0, -end, (0.0, -1.0)),
                corner(shaft, -end, -1, edge, segments),
                point(shaft, neck, (1.0, 0.0)),
                point(shaft, neck, (0.0, -1.0)),
                _spike(radius, neck, end),
            ]
        ),
    )
    # z, x, y to x, y, z is a rotation: the arrow lies down along x.
    return Mesh(
        np.roll(upright.vertices, 1, axis=1), np.roll(upright.normals, 1, axis=1), upright.faces
    )


def _spike(radius: float, base: float, tip: float) -> Profile:
    """From the rim of a flat base, facing down, to the tip."""
    length = tip - base
    slant = hypot(length, radius)
    sideways = (length / slant, radius / slant)
    return np.concatenate(
        [
            point(radius, base, (0.0, -1.0)),
            point(radius, base, sideways),
            point(0.0, tip, sideways),
        ]
    )
