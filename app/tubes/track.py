"""Places along one segment, with a frame at each.

A *track* is an array (`TRACK_ROWS`, m) whose columns are places and whose rows are points 0 to 2,
unit tangents 3 to 5, a first normal 6 to 8 and a second 9 to 11 that make a right-handed frame with
the tangent, and two numbers, 12 and 13, that place a direction in it. Rows of equal kind lie
together, so that the compiler makes vectors of the loops over them.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from app.arrays import Floats
from app.tubes.frames import basis, carry, turn

TRACK_ROWS = 14


@njit(cache=True, error_model="numpy")
def follow(
    control_points: Floats,
    positions: Floats,
    tangents: Floats,
    s: int,
    tiny: float,
    slopes: Floats,
    parameters: Floats,
    count: int,
    track: Floats,
) -> None:
    """Fill points and tangents of a track at ``parameters`` of segment ``s``."""
    p, q, r = control_points[s, 0, 0], control_points[s, 0, 1], control_points[s, 0, 2]
    a, b, c = slopes[0], slopes[3], slopes[6]
    d, e, f = slopes[1], slopes[4], slopes[7]
    g, h, k = slopes[2], slopes[5], slopes[8]
    third = 1.0 / 3.0
    for i in range(count):
        t = parameters[i]
        track[0, i] = p + t * (a + t * (0.5 * b + t * (third * c)))
        track[1, i] = q + t * (d + t * (0.5 * e + t * (third * f)))
        track[2, i] = r + t * (g + t * (0.5 * h + t * (third * k)))
        x, y, z = a + t * (b + t * c), d + t * (e + t * f), g + t * (h + t * k)
        square = x * x + y * y + z * z
        inverse = 1.0 / math.sqrt(square)
        track[3, i], track[4, i], track[5, i] = x * inverse, y * inverse, z * inverse
        track[6, i] = square
    for axis in range(3):
        track[axis, 0], track[axis, count - 1] = positions[s, 0, axis], positions[s, 1, axis]
        track[3 + axis, 0] = tangents[s, 0, axis]
        track[3 + axis, count - 1] = tangents[s, 1, axis]
    for i in range(1, count - 1):
        if not track[6, i] > tiny:
            for axis in range(3, 6):
                track[axis, i] = track[axis, i - 1]


@njit(cache=True, error_model="numpy")
def align(axes: Floats, senses: Floats, s: int, n: int, count: int, track: Floats) -> int:
    """Fill a track's frames: at both ends those that belong to the axes, as little turned between.

    What is left of a turn, at most half a side, is spread over the steps. Returns how many sides
    the last frame is ahead of the first one carried along.
    """
    end = count - 1
    track[12, 0], track[13, 0] = 1.0, 0.0
    if senses[s, 0] < 0.0:
        _express(axes, s, 0, track, 0)
    carry(track, count)
    c, d = track[12, end], track[13, end]
    _express(axes, s, 1, track, end)
    angle = math.atan2(
        c * track[13, end] - d * track[12, end], c * track[12, end] + d * track[13, end]
    )
    side = 2.0 * math.pi / n
    skipped = int(np.rint(angle / side))
    turn(track, end, (angle - skipped * side) / end)
    for which in range(2):
        i, sense = which * end, senses[s, which]
        frame = basis(axes[s, which, 0], axes[s, which, 1], axes[s, which, 2])
        track[6, i], track[7, i], track[8, i] = frame[0], frame[1], frame[2]
        track[9, i], track[10, i] = sense * frame[3], sense * frame[4]
        track[11, i] = sense * frame[5]
    return skipped


@njit(cache=True, error_model="numpy")
def _express(axes: Floats, s: int, which: int, track: Floats, i: int) -> None:
    """Where in the frame of the tangent at place ``i`` the axis's first normal lies."""
    x, y, z, _, _, _ = basis(axes[s, which, 0], axes[s, which, 1], axes[s, which, 2])
    u, v, w, p, q, r = basis(track[3, i], track[4, i], track[5, i])
    track[12, i] = x * u + y * v + z * w
    track[13, i] = x * p + y * q + z * r
