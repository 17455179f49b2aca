"""Places on an item's surface where hyperedges can end side by side."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TypeAlias, assert_never

import numpy as np

from app.arrays import Floats
from app.placement.points import UP
from app.placement.turning import Vector
from app.solids.rounds import SHAFT
from app.solids.solid import Arrow, Box, Cone, Csg, Cylinder, Size, Solid, Sphere, Text, Tray

Slots: TypeAlias = Floats
"""Positions and unit directions (k, 6) about an item's centre, in its own axes, best ones first."""

NOTHING = np.zeros((0, 6))

OFFERED = 4
"""Slots for each that is wanted, at most: a large item has room for millions."""

LOWEST = 0.6 * math.pi
"""Angle from the top of a ball beyond which there are no slots: it may stand on something."""


ASIDE = 0.75
"""Of slots from the edges of a block that floats, over a tube's thickness: so they are far enough
from those of its other sides."""

LEAST_FRONT = -0.3
"""How far to the front slots around a cylinder may look."""


def default_slots(
    solid: Solid, size: Size, count: int, pitch: float, inset: float
) -> tuple[Slots, Slots]:
    """Slots on top of an item, and on its sides, at least ``pitch`` apart.

    There are some more than ``count``, where there is room; ``inset`` from the top's edges.
    """
    most = OFFERED * count + 16
    match solid:
        case Box():
            return _top(size, most, pitch, inset), _sides(size, most, pitch)
        case Text():
            return _top(size, most, pitch, inset), NOTHING
        case Tray():
            return _rim(solid, most, pitch, inset)
        case Sphere(radius=radius):
            return _rings(_on_ball(radius, pitch), most, pitch), NOTHING
        case Cylinder(radius=radius, height=height):
            grid = _grid(radius - inset, radius - inset, most, pitch)
            disc = grid[np.hypot(*grid.T) <= max(radius - inset, 0.0) + 1e-9]
            heights = height / 2 - pitch * np.arange(1, min(int(height / pitch), most))
            around = _rings(((radius, z, 1.0, 0.0) for z in heights.tolist()), most, pitch)
            return _facing(np.column_stack([disc, np.full(len(disc), height / 2)]), UP), around
        case Cone():
            return _rings(_on_cone(solid, pitch), most, pitch), NOTHING
        case Arrow(length=length, radius=radius):
            along = _steps(length / 2 - inset, most, pitch)
            line = np.zeros((len(along), 3))
            line[:, 0], line[:, 2] = along, SHAFT * radius
            return _facing(line, UP), NOTHING
        case Csg(top=top):
            return _facing(np.array([top]), UP), NOTHING
        case _:
            assert_never(solid)


def all_round_slots(solid: Solid, size: Size, count: int, pitch: float, thickness: float) -> Slots:
    """Slots on all sides of an item that floats, but for its front, where its label is.

    They are at least ``pitch`` apart on a side, and from one side to another as far as tubes of
    this ``thickness`` need; in no order. What is neither a block nor a cylinder has them where it
    has them on the ground.
    """
    most = OFFERED * count + 16
    if isinstance(solid, Box):
        return _faces(size, most, pitch, ASIDE * thickness)
    top, sides = default_slots(solid, size, count, pitch, ASIDE * thickness)
    if isinstance(solid, Cylinder):
        below = top.copy()
        below[:, [2, 5]] *= -1.0
        top = np.concatenate([top, below])
        if len(sides) == 0:
            sides = _rings(iter([(solid.radius, 0.0, 1.0, 0.0)]), most, pitch)
        sides = sides[sides[:, 4] >= LEAST_FRONT]
    return np.concatenate([top, sides])


def _faces(size: Size, most: int, pitch: float, inset: float) -> Slots:
    """All faces of a block but its front, each with one slot at least."""
    found = []
    for axis, side in ((0, -1.0), (0, 1.0), (1, 1.0), (2, -1.0), (2, 1.0)):
        others = [other for other in range(3) if other != axis]
        grid = _grid(size[others[0]] / 2 - inset, size[others[1]] / 2 - inset, most, pitch)
        places = np.zeros((len(grid), 3))
        places[:, others], places[:, axis] = grid, side * size[axis] / 2
        normals = np.zeros((len(grid), 3))
        normals[:, axis] = side
        found.append(np.hstack([places, normals]))
    return np.concatenate(found)


def point_slots(position: Vector, direction: Vector, size: Size, count: int, pitch: float) -> Slots:
    """Slots around a named point, in the plane that its direction is square to, nearest first.

    None is beyond the item's size, but the point itself is one, wherever it is.
    """
    at, normal = np.array(position), np.array(direction)
    upright = np.array([0.0, 0.0, 1.0]) if abs(normal[2]) < 0.9 else np.array([0.0, 1.0, 0.0])
    across = np.cross(upright, normal)
    across /= np.linalg.norm(across)
    frame = np.stack([across, np.cross(normal, across)])
    # Around a point in a corner a quarter of the plane is within the item.
    side = math.ceil(2 * math.sqrt(count)) + 2
    steps = np.arange(-side, side + 1) * pitch
    grid = _nearest_first(np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1))
    places = at + grid @ frame
    limits = np.maximum(np.array(size) / 2, np.abs(at)) + 1e-9
    return _facing(places[(np.abs(places) <= limits).all(axis=1)], direction)


def _top(size: Size, most: int, pitch: float, inset: float) -> Slots:
    x, y, z = (length / 2 for length in size)
    places = _grid(x - inset, y - inset, most, pitch)
    return _facing(np.column_stack([places, np.full(len(places), z)]), UP)


def _sides(size: Size, most: int, pitch: float) -> Slots:
    """A block's back, its sides, and its front last, where its label is.

    Slots are so far from all edges that those of two faces are a pitch apart; of two faces that are
    nearer to each other only the first has any.
    """
    x, y, z = (length / 2 for length in size)
    found = [NOTHING]
    for axis, side in ((1, 1.0), (0, 1.0), (0, -1.0), (1, -1.0)):
        width, depth = ((y, x), (x, y))[axis]
        is_second = (axis, side) in {(0, -1.0), (1, -1.0)}
        if min(width, z) < pitch or (is_second and 2 * depth < pitch):
            continue
        grid = _grid(width - pitch, z - pitch, most, pitch)
        places = np.zeros((len(grid), 3))
        places[:, 1 - axis], places[:, axis], places[:, 2] = grid[:, 0], side * depth, grid[:, 1]
        found.append(_facing(places, (side * (1 - axis), side * axis, 0.0)))
    return np.concatenate(found)


def _rim(tray: Tray, most: int, pitch: float, inset: float) -> tuple[Slots, Slots]:
    """The rim of the back wall, and of the walls at its sides."""
    x, y, z = (length / 2 for length in tray.size)
    middle = tray.wall / 2
    along = _steps(x - inset, most, pitch)
    back = np.column_stack([along, np.full(len(along), y - middle), np.full(len(along), z)])
    along = _steps(y - inset, most, pitch)
    # Not so far back that they come near the back wall's.
    along = along[along <= y - middle - pitch]
    walls = [
        np.column_stack([np.full(len(along), at), along, np.full(len(along), z)])
        for at in (x - middle, middle - x)
    ]
    return _facing(back, UP), _facing(np.concatenate(walls), UP)


def _on_ball(radius: float, pitch: float) -> Iterator[tuple[float, float, float, float]]:
    """Rings around the top of a ball, whose chords from one to the next are a pitch."""
    step = 2 * math.asin(min(pitch / (2 * radius), 1.0))
    angle = 0.0
    while angle <= LOWEST:
        yield radius * math.sin(angle), radius * math.cos(angle), math.sin(angle), math.cos(angle)
        angle += step


def _on_cone(cone: Cone, pitch: float) -> Iterator[tuple[float, float, float, float]]:
    """The tip, and rings down its slope."""
    slant = math.hypot(cone.radius, cone.height)
    way = 0.0
    while way <= slant:
        share = way / slant
        outward, upward = cone.height / slant, cone.radius / slant
        if way == 0.0:
            outward, upward = 0.0, 1.0
        yield cone.radius * share, cone.height * (0.5 - share), outward, upward
        way += pitch


def _rings(rings: Iterator[tuple[float, float, float, float]], most: int, pitch: float) -> Slots:
    """Slots on rings around z: radius, height, outward and upward parts of the directions."""
    found, total = [NOTHING], 0
    for radius, height, outward, upward in rings:
        share = pitch / (2 * radius) if radius > 0.0 else 1.0
        count = int(math.pi / math.asin(share) + 1e-9) if share < 1.0 else 1
        angles = 2 * math.pi * np.arange(min(count, most)) / count
        x, y, ones = np.sin(angles), np.cos(angles), np.ones(len(angles))
        found.append(
            np.column_stack(
                [radius * x, radius * y, height * ones, outward * x, outward * y, upward * ones]
            )
        )
        total += len(angles)
        if total >= most:
            break
    return np.concatenate(found)


def _facing(places: Floats, direction: Vector) -> Slots:
    return np.column_stack([places, np.tile(direction, (len(places), 1))])


def _grid(width: float, depth: float, most: int, pitch: float) -> Floats:
    """Crossings (k, 2) of a square grid about the middle, those nearest to it first.

    Where there is room for more than ``most``, about so many of them.
    """
    side = math.ceil(math.sqrt(most))
    fits = [len(_steps(reach, most, pitch)) for reach in (width, depth)]
    x = _steps(width, max(side, math.ceil(most / fits[1])), pitch)
    y = _steps(depth, max(side, math.ceil(most / fits[0])), pitch)
    return _nearest_first(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1))


def _nearest_first(grid: Floats) -> Floats:
    flat = grid.reshape(-1, 2)
    return flat[np.argsort(np.round((flat**2).sum(axis=1), 9), kind="stable")]


def _steps(reach: float, most: int, pitch: float) -> Floats:
    """As many steps of ``pitch`` as fit within ``reach`` on either side of zero, one at least."""
    count = min(int(2.0 * max(reach, 0.0) / pitch + 1e-9) + 1, most)
    return (np.arange(count) - (count - 1) / 2) * np.float64(pitch)
