"""Frames along curves: a tangent and two normals, turning about the tangent as little as can be."""

from __future__ import annotations

import math

from numba import njit

from app.arrays import Floats

# Below this squared length a sum or difference of unit vectors is rounding noise.
_NOISE = 1e-20


@njit(cache=True, error_model="numpy")
def basis(x: float, y: float, z: float) -> tuple[float, float, float, float, float, float]:
    """Two unit vectors that make a right-handed frame with the unit vector (x, y, z).

    They depend on that vector alone, so whoever knows the tangent knows the frame. Branchless:
    Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.

    >>> basis(0.0, 1.0, 0.0)
    (1.0, -0.0, -0.0, -0.0, 0.0, -1.0)
    """
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return 1.0 + sign * x * x * a, sign * b, -sign * x, b, sign + y * y * a, -y


@njit(cache=True, error_model="numpy")
def carry(track: Floats, count: int) -> None:
    """Carry a direction along a track's first ``count`` places, without turning it.

    Fills the normals from the tangents alone, and rows 12 and 13 with where in that frame the
    direction comes to lie that is at ``track[12:, 0]`` at the first place. Double reflection: Wang,
    Jüttler, Zheng and Liu, "Computation of Rotation Minimizing Frames", ACM Transactions on
    Graphics 27(1), 2008. Where two places coincide, the direction follows the tangent's shortest
    turn.

    A step turns all directions by the same angle against the frames, so the steps are found
    independently of each other (which the compiler makes vectors of), and then multiplied.
    """
    for i in range(count):
        u, v, w, x, y, z = basis(track[3, i], track[4, i], track[5, i])
        track[6, i], track[7, i], track[8, i] = u, v, w
        track[9, i], track[10, i], track[11, i] = x, y, z
    for i in range(count - 1):
        tx, ty, tz = track[3, i], track[4, i], track[5, i]
        ex, ey, ez = track[3, i + 1], track[4, i + 1], track[5, i + 1]
        x, y, z = track[0, i + 1] - track[0, i], track[1, i + 1] - track[1, i], 0.0
        z = track[2, i + 1] - track[2, i]
        square = x * x + y * y + z * z
        apart = square > 1e-300
        x, y, z = x if apart else tx + ex, y if apart else ty + ey, z if apart else tz + ez
        square = x * x + y * y + z * z
        back = not apart and square < _NOISE
        x, y, z = tx if back else x, ty if back else y, tz if back else z
        scale = 2.0 / (1.0 if back else square)
        u, v, w = track[6, i], track[7, i], track[8, i]
        along = scale * (x * u + y * v + z * w)
        u, v, w = u - along * x, v - along * y, w - along * z
        along = scale * (x * tx + y * ty + z * tz)
        x, y, z = ex - (tx - along * x), ey - (ty - along * y), ez - (tz - along * z)
        square = x * x + y * y + z * z
        along = (x * u + y * v + z * w) * (2.0 / square if square > _NOISE else 0.0)
        u, v, w = u - along * x, v - along * y, w - along * z
        c = u * track[6, i + 1] + v * track[7, i + 1] + w * track[8, i + 1]
        s = u * track[9, i + 1] + v * track[10, i + 1] + w * track[11, i + 1]
        unit = 1.0 / math.sqrt(c * c + s * s)
        track[12, i + 1], track[13, i + 1] = c * unit, s * unit
    c, s = track[12, 0], track[13, 0]
    for i in range(1, count):
        x, y = track[12, i], track[13, i]
        c, s = c * x - s * y, c * y + s * x
        track[12, i], track[13, i] = c, s


@njit(cache=True, error_model="numpy")
def turn(track: Floats, count: int, twist: float) -> None:
    """Turn a track's frames to the carried directions, and on by ``twist`` at each step."""
    step_c, step_s = math.cos(twist), math.sin(twist)
    c, s = 1.0, 0.0
    for i in range(count):
        x, y = track[12, i], track[13, i]
        track[12, i], track[13, i] = c * x - s * y, c * y + s * x
        c, s = c * step_c - s * step_s, c * step_s + s * step_c
    for i in range(count):
        c, s = track[12, i], track[13, i]
        for axis in range(6, 9):
            u, v = track[axis, i], track[axis + 3, i]
            track[axis, i], track[axis + 3, i] = c * u + s * v, c * v - s * u
