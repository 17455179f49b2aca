"""Quaternions x, y, z, w: how items are turned within their parents."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from app.arrays import Floats

Quaternion: TypeAlias = tuple[float, float, float, float]
Vector: TypeAlias = tuple[float, float, float]

UNTURNED: Quaternion = (0.0, 0.0, 0.0, 1.0)

UPRIGHT: Quaternion = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""A quarter turn about x: letters lying on the ground stand up and face -y."""


def from_degrees(x: float, y: float, z: float) -> Quaternion:
    """The turn about x, then y, then z (the axes standing still), by so many degrees.

    >>> from_degrees(0, 0, 180)[2]
    1.0
    """
    quaternion = UNTURNED
    for axis, degrees in enumerate((x, y, z)):
        if degrees:
            half = math.radians(math.remainder(degrees, 360.0)) / 2
            turn = [0.0, 0.0, 0.0, math.cos(half)]
            turn[axis] = math.sin(half)
            quaternion = then((turn[0], turn[1], turn[2], turn[3]), quaternion)
    return quaternion


def then(second: Quaternion, first: Quaternion) -> Quaternion:
    """The turn that does ``first``, then ``second`` (Hamilton's product second · first)."""
    x, y, z, w = second
    a, b, c, d = first
    return (
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def turned(quaternion: Quaternion, vector: Vector) -> Vector:
    """``vector`` after the turn."""
    if quaternion == UNTURNED:
        return vector
    x, y, z, w = quaternion
    a, b, c = vector
    # v + 2 q × (q × v + w v)
    i, j, k = y * c - z * b + w * a, z * a - x * c + w * b, x * b - y * a + w * c
    return (a + 2 * (y * k - z * j), b + 2 * (z * i - x * k), c + 2 * (x * j - y * i))


def moved(place: Vector, by: Vector) -> Vector:
    """``place`` after a move."""
    return (place[0] + by[0], place[1] + by[1], place[2] + by[2])


def turning_up_to(direction: Vector) -> Quaternion:
    """The shortest turn that takes z to ``direction``, which is of any length but not zero.

    >>> turning_up_to((0.0, 0.0, 5.0))
    (0.0, 0.0, 0.0, 1.0)
    """
    x, y, z = _unit(direction)
    if x == y == 0.0:
        return UNTURNED if z > 0 else (1.0, 0.0, 0.0, 0.0)
    # Of the direction itself: in the unit vector, what is very short has lost its digits.
    along_x, along_y, _ = _unit((direction[0], direction[1], 0.0))
    half = math.atan2(math.hypot(x, y), z) / 2
    return (-along_y * math.sin(half), along_x * math.sin(half), 0.0, math.cos(half))


def _unit(vector: Vector) -> Vector:
    """A vector of any length but zero, as one of length 1."""
    _, exponent = math.frexp(max(map(abs, vector)))
    # A power of two costs no digits, and neither squares nor quotients leave the range of numbers.
    x, y, z = (math.ldexp(component, -exponent) for component in vector)
    length = math.hypot(x, y, z)
    return (x / length, y / length, z / length)


def reach(quaternion: Quaternion, size: Vector) -> Vector:
    """Size, along the standing axes, of the box around a turned box of ``size``."""
    if quaternion == UNTURNED:
        return size
    columns = [
        turned(quaternion, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    ]
    x, y, z = (
        sum(abs(column[axis]) * length for column, length in zip(columns, size, strict=True))
        for axis in range(3)
    )
    return (x, y, z)


def matrices(quaternions: Floats) -> Floats:
    """Rotation matrices (…, 3, 3) of unit quaternions (…, 4): they turn columns.

    >>> matrices(np.array([0.0, 0.0, 0.0, 1.0])).tolist()
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    q = np.asarray(quaternions, dtype=np.float64)
    x, y, z, w = q[..., 0], q[..., 1], q[..., 2], q[..., 3]
    found = np.empty((*q.shape[:-1], 3, 3))
    found[..., 0, 0] = 1 - 2 * (y * y + z * z)
    found[..., 1, 1] = 1 - 2 * (x * x + z * z)
    found[..., 2, 2] = 1 - 2 * (x * x + y * y)
    found[..., 0, 1], found[..., 1, 0] = 2 * (x * y - z * w), 2 * (x * y + z * w)
    found[..., 0, 2], found[..., 2, 0] = 2 * (x * z + y * w), 2 * (x * z - y * w)
    found[..., 1, 2], found[..., 2, 1] = 2 * (y * z - x * w), 2 * (y * z + x * w)
    return found
