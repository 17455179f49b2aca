"""Solids as boxes that hold them: as few as are tight (a solid lies in the union of its boxes)."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple, assert_never

import numpy as np

from app.arrays import Floats
from app.solids.blocks import hollow
from app.solids.rounds import HEAD, SHAFT
from app.solids.solid import Arrow, Box, Cone, Csg, Cylinder, Size, Solid, Sphere, Text, Tray

AROUND = 4
"""Boxes around the axis of a cylinder. Together they are the octagon around its circle, eight
percent of the radius beyond it at the corners."""

SLICES = 4
"""Cylinders that hold a cone."""


class Boxes(NamedTuple):
    """Boxes that are rounded on the outside.

    ``centers`` (k, 3); the columns of ``rotations`` (k, 3, 3) are their axes; ``halves`` (k, 3) are
    half their sizes; all that is nearer to a box than its ``roundings`` (k,) belongs to it as well.
    """

    centers: Floats
    rotations: Floats
    halves: Floats
    roundings: Floats


@lru_cache(maxsize=4096)
def hull(solid: Solid, size: Size) -> Boxes:
    """Boxes that hold ``solid`` in its own axes, where ``size`` is that of the box around it.

    >>> hull(Sphere(2.0), (4.0, 4.0, 4.0)).roundings.tolist()
    [2.0]
    """
    match solid:
        case Box() | Text() | Csg():
            return _upright([(0.0, 0.0, 0.0)], [size])
        case Tray():
            return _tray(solid)
        case Sphere(radius=radius):
            ball = _upright([(0.0, 0.0, 0.0)], [(0.0, 0.0, 0.0)])
            return ball._replace(roundings=np.array([radius]))
        case Cylinder(radius=radius, height=height):
            return _cylinder(radius, -height / 2, height / 2)
        case Cone(radius=radius, height=height):
            return _cone(radius, -height / 2, height / 2)
        case Arrow():
            return _arrow(solid)
        case _:
            assert_never(solid)


def _upright(centers: list[Size], sizes: list[Size]) -> Boxes:
    return Boxes(
        np.array(centers),
        np.tile(np.eye(3), (len(centers), 1, 1)),
        np.array(sizes) / 2,
        np.zeros(len(centers)),
    )


def _together(parts: list[Boxes]) -> Boxes:
    return Boxes(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


def _tray(tray: Tray) -> Boxes:
    """A floor and four walls, so thick that they hold the hollow's round corners too."""
    width, depth, rise = tray.size
    bend, wall, floor = hollow(tray)
    # Where a corner is as far from both walls; its coarsest polygon has three steps.
    wall += (bend - wall) * (1 - math.cos(math.pi / 12) * math.sqrt(0.5))
    x, y = (width - wall) / 2, (depth - wall) / 2
    return _upright(
        [(0, 0, (floor - rise) / 2), (x, 0, 0), (-x, 0, 0), (0, y, 0), (0, -y, 0)],
        [(width, depth, floor), *[(wall, depth, rise)] * 2, *[(width, wall, rise)] * 2],
    )


def _cylinder(radius: float, low: float, high: float) -> Boxes:
    angles = np.arange(AROUND) * (np.pi / AROUND)
    turns = np.zeros((AROUND, 3, 3))
    turns[:, 0, 0] = turns[:, 1, 1] = np.cos(angles)
    turns[:, 1, 0] = np.sin(angles)
    turns[:, 0, 1] = -turns[:, 1, 0]
    turns[:, 2, 2] = 1.0
    side = radius * math.tan(math.pi / (2 * AROUND))
    return Boxes(
        np.tile([0.0, 0.0, (low + high) / 2], (AROUND, 1)),
        turns,
        np.tile([radius, side, (high - low) / 2], (AROUND, 1)),
        np.zeros(AROUND),
    )


def _cone(radius: float, low: float, high: float) -> Boxes:
    cuts = np.linspace(low, high, SLICES + 1).tolist()
    radii = np.linspace(radius, 0.0, SLICES + 1).tolist()
    return _together(
        [_cylinder(radii[k], cuts[k], cuts[k + 1]) for k in range(SLICES)],
    )


def _arrow(arrow: Arrow) -> Boxes:
    radius, end = arrow.radius, arrow.length / 2
    neck = end - min(HEAD * radius, end)
    upright = _together([_cylinder(SHAFT * radius, -end, neck), _cone(radius, neck, end)])
    # z, x, y to x, y, z is a rotation: the arrow lies down along x.
    return upright._replace(
        centers=np.roll(upright.centers, 1, axis=1), rotations=np.roll(upright.rotations, 1, axis=1)
    )
