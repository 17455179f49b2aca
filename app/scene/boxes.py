"""Boxes around many meshes at once."""

from __future__ import annotations

import numpy as np

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
    filled = np.flatnonzero(np.diff(starts))
    if len(filled):
        first = starts[filled]
        end = starts[filled[-1] + 1]
        found[filled, 0] = np.minimum.reduceat(vertices[:end], first, axis=0)
        found[filled, 1] = np.maximum.reduceat(vertices[:end], first, axis=0)
    return found
