"""Sphere, cylinder, cone and arrow: profiles led around a circle."""

from __future__ import annotations

import math

import numpy as np

from app.solids.lathe import Profile, circle, corner, point, quarters, turn
from app.solids.mesh import Mesh
from app.solids.rounding import rounding, steps
from app.solids.solid import Arrow, Cone, Cylinder, Sphere

SIDES = 32
"""A circle's polygon is then at most half a hundredth of its radius inside it."""

FEWEST_SIDES = 8
"""However small a circle is in the picture: who flies up to it sees edges, but a circle."""

SHAFT = 0.45
"""Radius of an arrow's shaft, of its head's."""

HEAD = 2.4
"""Length of an arrow's head, of its radius, where the arrow is not too short."""


def round_mesh(solid: Sphere | Cylinder | Cone | Arrow, coarseness: float = 0.0) -> Mesh:
    """The mesh of a solid with an axis of revolution, off by ``coarseness`` at most."""
    match solid:
        case Sphere():
            return _sphere(solid, coarseness)
        case Cylinder():
            return _cylinder(solid, coarseness)
        case Cone():
            return _cone(solid, coarseness)
        case Arrow():
            return _arrow(solid, coarseness)


def _sides(radius: float, coarseness: float) -> int:
    """A multiple of four, as `circle` wants it."""
    found = steps(radius, math.tau, SIDES, coarseness)
    return max(FEWEST_SIDES, 4 * math.ceil(found / 4))


def _sphere(sphere: Sphere, coarseness: float) -> Mesh:
    sides = _sides(sphere.radius, coarseness)
    normals = quarters(-1, 2, sides // 4)
    return turn(circle(sides), np.column_stack([sphere.radius * normals, normals]))


def _cylinder(cylinder: Cylinder, coarseness: float) -> Mesh:
    """``edge`` is held below the radius and half the height."""
    radius, z = cylinder.radius, cylinder.height / 2
    edge, segments = rounding(
        cylinder.edge, limit=2 * min(radius, z), reach=max(radius, z), coarseness=coarseness
    )
    return turn(
        circle(_sides(radius, coarseness)),
        np.concatenate(
            [
                point(0.0, -z, (0.0, -1.0)),
                corner(radius, -z, -1, edge, segments),
                corner(radius, z, 0, edge, segments),
                point(0.0, z, (0.0, 1.0)),
            ]
        ),
    )


def _cone(cone: Cone, coarseness: float) -> Mesh:
    z = cone.height / 2
    profile = [point(0.0, -z, (0.0, -1.0)), _spike(cone.radius, -z, z)]
    return turn(circle(_sides(cone.radius, coarseness)), np.concatenate(profile))


def _arrow(arrow: Arrow, coarseness: float) -> Mesh:
    """A shaft and a head a little longer than wide, or half as long as the arrow if it is short."""
    radius, end = arrow.radius, arrow.length / 2
    neck = end - min(HEAD * radius, end)
    shaft = SHAFT * radius
    edge, segments = rounding(
        0.15 * shaft,
        limit=min(2 * shaft, neck + end),
        reach=max(end, radius),
        coarseness=coarseness,
    )
    upright = turn(
        circle(_sides(radius, coarseness)),
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
    slant = math.hypot(length, radius)
    sideways = (length / slant, radius / slant)
    return np.concatenate(
        [
            point(radius, base, (0.0, -1.0)),
            point(radius, base, sideways),
            point(0.0, tip, sideways),
        ]
    )
