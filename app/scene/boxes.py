"""Boxes around many meshes at once."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices, Singles


def boxes(vertices: Singles, starts: Indices) -> Floats:
    """Smallest and largest corner of each group of vertices, (g, 2, 3).

    ``vertices`` (v, 3); group k is ``starts[k]`` to ``starts[k + 1]`` (g + 1,). An empty group
    has the origin twice.

    >>> points = np.array([[0, 0, 0], [1, -2, 3], [5, 5, 5]], dtype=np.float32)
    >>> boxes(points, np.array([0, 2, 2, 3])).tolist()
    [[[0.0, -2.0, 0.0], [1.0, 0.0, 3.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], \
[[5.0, 5.0, 5.0], [5.0, 5.0, 5.0]]]
    """
    found = np.zeros((len(starts) - 1, 2, 3))
    _enclose(vertices, starts, found)
    return found


@njit(cache=True, error_model="numpy", nogil=True)
def _enclose(vertices: Singles, starts: Indices, found: Floats) -> None:
    for group in range(len(starts) - 1):
        first, last = starts[group], starts[group + 1]
        if first == last:
            continue
        for axis in range(3):
            low = high = vertices[first, axis]
            for vertex in range(first + 1, last):
                low, high = min(low, vertices[vertex, axis]), max(high, vertices[vertex, axis])
            found[group, 0, axis], found[group, 1, axis] = low, high


def around_their_middles(vertices: Singles, starts: Indices) -> tuple[Singles, Singles, Floats]:
    """Groups of vertices (v, 3) moved to the origin, by how much (g, 3), and their boxes there.

    Groups and boxes (g, 2, 3) are as in `boxes`. Each group is moved by the middle of its box,
    rounded to single precision: so the difference loses nothing where coordinates are large.
    """
    count = len(starts) - 1
    moved = np.empty_like(vertices)
    middles = np.zeros((count, 3), dtype=np.float32)
    found = np.zeros((count, 2, 3))
    _center(vertices, starts, moved, middles, found)
    return moved, middles, found


@njit(cache=True, error_model="numpy", nogil=True)
def _center(
    vertices: Singles, starts: Indices, moved: Singles, middles: Singles, found: Floats
) -> None:
    for group in range(len(starts) - 1):
        first, last = starts[group], starts[group + 1]
        if first == last:
            continue
        for axis in range(3):
            low = high = vertices[first, axis]
            for vertex in range(first + 1, last):
                low, high = min(low, vertices[vertex, axis]), max(high, vertices[vertex, axis])
            middle = np.float32(0.5 * (np.float64(low) + np.float64(high)))
            middles[group, axis] = middle
            found[group, 0, axis] = np.float64(low) - middle
            found[group, 1, axis] = np.float64(high) - middle
            for vertex in range(first, last):
                moved[vertex, axis] = vertices[vertex, axis] - middle
