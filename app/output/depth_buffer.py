"""A z-buffer without OpenGL: how far away the nearest surface is at each pixel."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats
from app.output.projection import Projection
from app.placement.turning import matrices
from app.scene.scene import Scene


def depths_of(scene: Scene, projection: Projection, shows: frozenset[str]) -> Floats:
    """Distance along the viewing axis (height, width) of nodes that ``shows`` names; else inf."""
    found = np.full((projection.height, projection.width), np.inf)
    for node in scene.nodes:
        if node.shows not in shows or not node.primitives:
            continue
        turn = matrices(np.array(node.rotation)).T
        for primitive in node.primitives:
            seen = projection(primitive.mesh.vertices @ turn + node.translation)
            _fill(found, seen, primitive.mesh.faces, projection.is_perspective)
    return found


@njit(cache=True)
def _fill(found, seen, faces, is_perspective):  # type: ignore[no-untyped-def]  # Numba
    height, width = found.shape
    for number in range(len(faces)):
        a, b, c = seen[faces[number, 0]], seen[faces[number, 1]], seen[faces[number, 2]]
        if a[2] <= 1e-9 or b[2] <= 1e-9 or c[2] <= 1e-9:
            continue
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if abs(area) < 1e-12:
            continue
        left = max(int(np.ceil(min(a[0], b[0], c[0]) - 0.5)), 0)
        right = min(int(np.floor(max(a[0], b[0], c[0]) - 0.5)), width - 1)
        top = max(int(np.ceil(min(a[1], b[1], c[1]) - 0.5)), 0)
        bottom = min(int(np.floor(max(a[1], b[1], c[1]) - 0.5)), height - 1)
        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                u = ((b[0] - x) * (c[1] - y) - (b[1] - y) * (c[0] - x)) / area
                v = ((c[0] - x) * (a[1] - y) - (c[1] - y) * (a[0] - x)) / area
                w = 1.0 - u - v
                if u < 0.0 or v < 0.0 or w < 0.0:
                    continue
                if is_perspective:
                    depth = 1.0 / (u / a[2] + v / b[2] + w / c[2])
                else:
                    depth = u * a[2] + v * b[2] + w * c[2]
                found[row, column] = min(found[row, column], depth)
