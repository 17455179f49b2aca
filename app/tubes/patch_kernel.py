"""The kernel that fills positions, normals and faces of patch pairs."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices, Singles
from app.tubes.circle import FEWEST_SIDES, MOST_SIDES
from app.tubes.rings import hodograph, place_rings
from app.tubes.stacks import write_faces


@lru_cache(maxsize=1)
def half_circles() -> Floats:
    """Weights of a patch's four columns at each side of half a ring: [sides, side, 0 or 1, column].

    With 1 as the third index, the weights of the derivative.
    """
    table = np.zeros((MOST_SIDES + 1, MOST_SIDES // 2 + 1, 2, 4))
    for sides in range(FEWEST_SIDES, MOST_SIDES + 1, 2):
        v = np.arange(sides // 2 + 1) / (sides // 2)
        table[sides, : len(v)] = np.stack([_bernstein(v), _bernstein_slopes(v)], axis=1)
    table.setflags(write=False)
    return table


def _bernstein(t: Floats) -> Floats:
    u = 1.0 - t
    return np.stack([u**3, 3 * t * u**2, 3 * t**2 * u, t**3], axis=1)


def _bernstein_slopes(t: Floats) -> Floats:
    u = 1.0 - t
    return np.stack([-3 * u**2, 3 * u * (u - 2 * t), 3 * t * (2 * u - t), 3 * t**2], axis=1)


@njit(cache=True, error_model="numpy")
def fill_patches(
    pairs: Floats,
    control_points: Floats,
    radii: Floats,
    tangents: Floats,
    free: NDArray[np.bool_],
    tiny: Floats,
    counts: Indices,
    loads: Floats,
    sharp: Indices,
    sides: Indices,
    rings: Indices,
    cap_rings: Indices,
    vertex_starts: Indices,
    face_starts: Indices,
    first_vertices: Indices,
    half_circles: Floats,
    latitudes: Floats,
    strips: NDArray[np.uint32],
    vertices: Singles,
    normals: Singles,
    faces: NDArray[np.uint32],
) -> None:
    """Fill the tubes of all ``pairs``; `Ends`, `RingPlan` and `Stacks` say what the arrays are.

    ``radii`` (s,) are the segments', ``faces`` is flat.
    """
    most = 2
    for s in range(len(pairs)):
        most = max(most, counts[s])
    parameters, columns = np.empty(most), np.empty((2, 2, 4, 3))
    slopes, finer = np.empty(9), np.empty(9)
    for s in range(len(pairs)):
        n, count = sides[s], counts[s]
        hodograph(control_points, s, slopes)
        place_rings(loads, sharp, slopes, tangents, s, tiny[s], radii[s], count, finer, parameters)
        rim = vertex_starts[s] + 1 + n * cap_rings[s, 0]
        for i in range(count):
            _cross(pairs, s, parameters[i], columns)
            _write_section(vertices, normals, rim + n * i, n, half_circles, columns)
        for end in range(2):
            _close(
                vertices,
                normals,
                rim + end * n * (count - 1),
                n,
                1 - 2 * (1 - end),
                cap_rings[s, end],
                latitudes,
                control_points[s, 3 * end],
                tangents[s, end],
                radii[s] if free[s, end] else 0.0,
            )
        write_faces(strips, faces, face_starts[s], first_vertices[s], n, rings[s], True, True)


@njit(cache=True, error_model="numpy")
def _cross(pairs: Floats, s: int, t: float, columns: Floats) -> None:
    """Control points of both patches' curves across at ``t``: [patch, 0 or 1, column].

    With 1 as the second index, their derivatives along the tube.
    """
    u = 1.0 - t
    for patch in range(2):
        for column in range(4):
            for axis in range(3):
                p0, p1 = pairs[s, patch, 0, column, axis], pairs[s, patch, 1, column, axis]
                p2, p3 = pairs[s, patch, 2, column, axis], pairs[s, patch, 3, column, axis]
                columns[patch, 0, column, axis] = u * u * (u * p0 + 3.0 * t * p1) + t * t * (
                    3.0 * u * p2 + t * p3
                )
                columns[patch, 1, column, axis] = 3.0 * (
                    u * u * (p1 - p0) + 2.0 * u * t * (p2 - p1) + t * t * (p3 - p2)
                )


@njit(cache=True, error_model="numpy")
def _write_section(
    vertices: Singles, normals: Singles, at: int, n: int, half_circles: Floats, columns: Floats
) -> None:
    """Write a ring: over the top from one seam to the other, and back along the bottom."""
    half = n // 2
    place, across, along = np.empty(3), np.empty(3), np.empty(3)
    for k in range(n):
        patch, side = (0, k) if k < half else (1, n - k)
        for axis in range(3):
            place[axis], across[axis], along[axis] = 0.0, 0.0, 0.0
            for column in range(4):
                weight, slope = half_circles[n, side, 0, column], half_circles[n, side, 1, column]
                place[axis] += weight * columns[patch, 0, column, axis]
                across[axis] += slope * columns[patch, 0, column, axis]
                along[axis] += weight * columns[patch, 1, column, axis]
        x = across[1] * along[2] - across[2] * along[1]
        y = across[2] * along[0] - across[0] * along[2]
        z = across[0] * along[1] - across[1] * along[0]
        # Away from the axis, also where the patch folds over itself in a tight bend.
        u = place[0] - 0.5 * (columns[0, 0, 0, 0] + columns[0, 0, 3, 0])
        v = place[1] - 0.5 * (columns[0, 0, 0, 1] + columns[0, 0, 3, 1])
        w = place[2] - 0.5 * (columns[0, 0, 0, 2] + columns[0, 0, 3, 2])
        if x * u + y * v + z * w < 0.0:
            x, y, z = -x, -y, -z
        length = math.sqrt(x * x + y * y + z * z)
        away = math.sqrt(u * u + v * v + w * w)
        span = math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
        run = math.sqrt(along[0] ** 2 + along[1] ** 2 + along[2] ** 2)
        if not length > 1e-9 * span * run:
            x, y, z, length = u, v, w, away
        if not length > 0.0:
            x, y, z, length = 0.0, 0.0, 1.0, 1.0
        for axis in range(3):
            vertices[at + k, axis] = place[axis]
        normals[at + k, 0], normals[at + k, 1] = x / length, y / length
        normals[at + k, 2] = z / length


@njit(cache=True, error_model="numpy")
def _close(
    vertices: Singles,
    normals: Singles,
    rim: int,
    n: int,
    sense: int,
    cap_rings: int,
    latitudes: Floats,
    centre: Floats,
    tangent: Floats,
    radius: float,
) -> None:
    """Close an end with ``cap_rings`` rings, and a pole ``radius`` beyond its centre.

    The tube's last ring begins at vertex ``rim``; ``sense`` is -1 where the tube begins, 1 where it
    ends, and says in which direction the vertices follow.
    """
    normal = np.empty(3)
    for j in range(cap_rings):
        across, along = latitudes[n, 0, j], latitudes[n, 1, j] * sense
        at = rim + sense * n * (cap_rings - j)
        for k in range(n):
            square = 0.0
            for axis in range(3):
                out = across * (vertices[rim + k, axis] - centre[axis])
                vertices[at + k, axis] = centre[axis] + out + along * radius * tangent[axis]
                normal[axis] = across * normals[rim + k, axis] + along * tangent[axis]
                square += normal[axis] ** 2
            for axis in range(3):
                normals[at + k, axis] = normal[axis] / math.sqrt(square)
    pole = rim + n * (1 + cap_rings) if sense > 0 else rim - n * cap_rings - 1
    for axis in range(3):
        vertices[pole, axis] = centre[axis] + sense * radius * tangent[axis]
        normals[pole, axis] = sense * tangent[axis]
