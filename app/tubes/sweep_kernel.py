"""The kernel that fills positions, normals and faces of swept tubes."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices, Singles
from app.tubes.rings import hodograph, place_rings
from app.tubes.stacks import write_faces
from app.tubes.track import TRACK_ROWS, align, follow


@njit(cache=True, error_model="numpy", nogil=True)
def fill_swept(
    first: int,
    last: int,
    control_points: Floats,
    hyperedges: Indices,
    radii: Floats,
    positions: Floats,
    axes: Floats,
    senses: Floats,
    tangents: Floats,
    tiny: Floats,
    counts: Indices,
    loads: Floats,
    sharp: Indices,
    sides: Indices,
    rings: Indices,
    cap_rings: Indices,
    poles: NDArray[np.bool_],
    vertex_starts: Indices,
    face_starts: Indices,
    first_vertices: Indices,
    circles: Singles,
    latitudes: Floats,
    strips: NDArray[np.uint32],
    vertices: Singles,
    normals: Singles,
    faces: NDArray[np.uint32],
) -> None:
    """Fill the tubes of segments ``first`` to ``last``.

    `Ends`, `RingPlan` and `Stacks` say what the arrays are. ``vertices``, ``normals`` and
    ``faces`` are flat.
    """
    most = 2
    for s in range(first, last):
        most = max(most, counts[s])
    parameters, track = np.empty(most), np.empty((TRACK_ROWS, most))
    slopes, finer = np.empty(9), np.empty(9)
    for s in range(first, last):
        radius, n, count = radii[hyperedges[s]], sides[s], counts[s]
        hodograph(control_points, s, slopes)
        place_rings(loads, sharp, slopes, tangents, s, tiny[s], radius, count, finer, parameters)
        follow(control_points, positions, tangents, s, tiny[s], slopes, parameters, count, track)
        shift = (n - align(axes, senses, s, n, count, track)) % n
        end = count - 1
        at = vertex_starts[s] + poles[s, 0]
        for ring in range(rings[s]):
            place = ring - cap_rings[s, 0]
            across, along = 1.0, 0.0
            if place < 0:
                across, along = latitudes[n, 0, ring], -latitudes[n, 1, ring]
            elif place > end:
                from_pole = rings[s] - 1 - ring
                across, along = latitudes[n, 0, from_pole], latitudes[n, 1, from_pole]
            place = min(max(place, 0), end)
            turned = shift if place == end else 0
            _write_ring(
                vertices, normals, at, n, turned, circles, radius, track, place, across, along
            )
            at += n
        for which in range(2):
            if poles[s, which]:
                at = vertex_starts[s + which] - which
                along = 2.0 * which - 1.0
                _write_pole(vertices, normals, at, radius, track, which * end, along)
        write_faces(
            strips,
            faces,
            face_starts[s],
            first_vertices[s],
            n,
            rings[s],
            poles[s, 0],
            poles[s, 1],
        )


@njit(cache=True, error_model="numpy")
def _write_ring(
    vertices: Singles,
    normals: Singles,
    at: int,
    n: int,
    shift: int,
    circles: Singles,
    radius: float,
    track: Floats,
    place: int,
    across: float,
    along: float,
) -> None:
    """Write ``n`` vertices around a ``place`` of a track, beginning ``shift`` sides on.

    Normals point ``across`` from the axis and ``along`` it. Opposite vertices are written
    together, and all is single precision with unsigned indices: three times as fast.
    """
    i = np.uint64(place)
    r = np.float32(radius)
    x, y, z = np.float32(track[0, i]), np.float32(track[1, i]), np.float32(track[2, i])
    ux, uy = np.float32(across * track[6, i]), np.float32(across * track[7, i])
    uz = np.float32(across * track[8, i])
    vx, vy = np.float32(across * track[9, i]), np.float32(across * track[10, i])
    vz = np.float32(across * track[11, i])
    wx, wy = np.float32(along * track[3, i]), np.float32(along * track[4, i])
    wz = np.float32(along * track[5, i])
    zero, one, two, three = np.uint64(0), np.uint64(1), np.uint64(2), np.uint64(3)
    sides, half, first = np.uint64(n), np.uint64(n // 2), np.uint64(shift)
    a = np.uint64(3 * at)
    b = a + three * half
    x, y, z = x + r * wx, y + r * wy, z + r * wz
    for k in range(half):
        c, s = circles[sides, zero, first + k], circles[sides, one, first + k]
        nx, ny, nz = ux * c + vx * s, uy * c + vy * s, uz * c + vz * s
        px, py, pz = r * nx, r * ny, r * nz
        normals[a], normals[a + one], normals[a + two] = wx + nx, wy + ny, wz + nz
        normals[b], normals[b + one], normals[b + two] = wx - nx, wy - ny, wz - nz
        vertices[a], vertices[a + one], vertices[a + two] = x + px, y + py, z + pz
        vertices[b], vertices[b + one], vertices[b + two] = x - px, y - py, z - pz
        a += three
        b += three


@njit(cache=True, error_model="numpy")
def _write_pole(
    vertices: Singles,
    normals: Singles,
    at: int,
    radius: float,
    track: Floats,
    place: int,
    along: float,
) -> None:
    for axis in range(3):
        normal = along * track[3 + axis, place]
        normals[3 * at + axis] = normal
        vertices[3 * at + axis] = track[axis, place] + radius * normal
