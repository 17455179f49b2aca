"""Where three points meet by the shortest way: Fermat's point, in closed form (Numba).

Points are rows of ``at`` (n, 3) and are named by row number.

Let S be twice the area of the triangle, and D the product of the two sides that leave a corner.
Where S + √3·D is negative or zero the angle at that corner is 120 degrees or more, and the corner
is the place. Otherwise the place has the barycentric weights 1 / (S + √3·D), which follow from the
trilinear coordinates csc(A + 60°) of the first isogonic centre, and the length is
√((a² + b² + c²) / 2 + √3·S).
"""

from __future__ import annotations

from math import sqrt

from numba import njit

from app.arrays import Floats

ROOT = sqrt(3.0)


@njit(cache=True, error_model="numpy")
def distance(at: Floats, i: int, j: int) -> float:
    """How far two points are apart."""
    x, y, z = at[j, 0] - at[i, 0], at[j, 1] - at[i, 1], at[j, 2] - at[i, 2]
    return sqrt(x * x + y * y + z * z)


@njit(cache=True, error_model="numpy")
def _corners(at: Floats, a: int, b: int, c: int) -> tuple[float, float, float, float, float, float]:
    """S + √3·D of each corner, then the squared sides ab, ac and the sum of all with S."""
    bx, by, bz = at[b, 0] - at[a, 0], at[b, 1] - at[a, 1], at[b, 2] - at[a, 2]
    cx, cy, cz = at[c, 0] - at[a, 0], at[c, 1] - at[a, 1], at[c, 2] - at[a, 2]
    dx, dy, dz = at[c, 0] - at[b, 0], at[c, 1] - at[b, 1], at[c, 2] - at[b, 2]
    x, y, z = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
    area = sqrt(x * x + y * y + z * z)
    first = area + ROOT * (bx * cx + by * cy + bz * cz)
    second = area - ROOT * (bx * dx + by * dy + bz * dz)
    third = area + ROOT * (cx * dx + cy * dy + cz * dz)
    ab = bx * bx + by * by + bz * bz
    ac = cx * cx + cy * cy + cz * cz
    bc = dx * dx + dy * dy + dz * dz
    return first, second, third, ab, ac, (ab + ac + bc) / 2.0 + ROOT * area


@njit(cache=True, error_model="numpy")
def meeting_length(at: Floats, a: int, b: int, c: int) -> float:
    """The length of the shortest network of three points."""
    first, second, third, ab, ac, square = _corners(at, a, b, c)
    if first <= 0.0:
        return sqrt(ab) + sqrt(ac)
    if second <= 0.0:
        return sqrt(ab) + distance(at, b, c)
    if third <= 0.0:
        return sqrt(ac) + distance(at, b, c)
    return sqrt(square)


@njit(cache=True, error_model="numpy")
def meet(at: Floats, a: int, b: int, c: int, place: int) -> float:
    """Move point ``place`` to where points a, b and c meet; the length of their network."""
    first, second, third, ab, ac, square = _corners(at, a, b, c)
    corner = -1
    if first <= 0.0:
        corner, length = a, sqrt(ab) + sqrt(ac)
    elif second <= 0.0:
        corner, length = b, sqrt(ab) + distance(at, b, c)
    elif third <= 0.0:
        corner, length = c, sqrt(ac) + distance(at, b, c)
    if corner >= 0:
        for axis in range(3):
            at[place, axis] = at[corner, axis]
        return length
    most = max(first, second, third)
    first, second, third = first / most, second / most, third / most
    toward_b, toward_c = first * third, first * second
    total = second * third + toward_b + toward_c
    toward_b, toward_c = toward_b / total, toward_c / total
    for axis in range(3):
        origin = at[a, axis]
        at[place, axis] = (
            origin + toward_b * (at[b, axis] - origin) + toward_c * (at[c, axis] - origin)
        )
    return sqrt(square)
