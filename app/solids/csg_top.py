"""Where something that comes from above meets a body."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats
from app.solids.mesh import Mesh

LEVEL = 1e-4
"""Of the height: what counts as high as the highest place."""

WAYS = ((0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0))
"""To the back, front, right, left."""


def top_of(mesh: Mesh, axis: tuple[float, float]) -> tuple[float, float, float]:
    """The highest place of ``mesh`` on the upright line through ``axis`` (x, y).

    Where that line meets nothing, as in the hole of a ring: the middle of the rim behind it, before
    it, right or left of it; else the highest vertex, and of equals the nearest. A line that goes by
    the body on the outside counts as one through the middle.
    """
    low, high = mesh.bounds
    if not all(low[k] <= axis[k] <= high[k] for k in range(2)):
        axis = (0.0, 0.0)
    corners = mesh.vertices[mesh.faces].astype(np.float64) - (*axis, 0.0)
    heights = _heights(corners)
    if len(heights):
        return (*axis, float(heights.max()))
    top = float(high[2])
    level = top - LEVEL * float(high[2] - low[2])
    rim = corners[(corners[..., 2] >= level).all(axis=1)]
    for way in WAYS:
        distance = _first_middle(rim, np.array(way))
        if distance is not None:
            return (axis[0] + distance * way[0], axis[1] + distance * way[1], top)
    vertices = corners.reshape(-1, 3)
    highest = vertices[vertices[:, 2] >= level]
    x, y, z = highest[int(np.argmin(np.hypot(highest[:, 0], highest[:, 1])))].tolist()
    return (axis[0] + x, axis[1] + y, z)


def _heights(corners: Floats) -> Floats:
    """Heights at which the upright line through the origin meets triangles (f, 3, 3)."""
    a, b, c = np.moveaxis(corners, 1, 0)

    def turning(p: Floats, q: Floats) -> Floats:
        return np.asarray(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])

    shares = np.stack([turning(b, c), turning(c, a), turning(a, b)], axis=1)
    area = shares.sum(axis=1)
    # A line through an edge or a corner meets the triangles on both sides of it.
    slack = 3e-7 * np.abs(corners[..., :2]).max(axis=(1, 2), initial=0.0) ** 2
    met = (area > slack) & (shares >= -slack[:, None]).all(axis=1)
    return np.asarray(np.einsum("fc,fc->f", shares[met], corners[met, :, 2]) / area[met])


def _first_middle(rim: Floats, way: Floats) -> float | None:
    """How far from the origin the middle of what a ray runs over first is, on triangles ``rim``."""
    along, aside = rim[..., :2] @ way, rim[..., :2] @ np.array([-way[1], way[0]])
    begins, ends = np.full(len(rim), np.inf), np.full(len(rim), -np.inf)
    for corner in range(3):
        other = (corner + 1) % 3
        one, two = aside[:, corner], aside[:, other]
        crossing = (one <= 0) != (two <= 0)
        share = np.divide(one, one - two, out=np.zeros_like(one), where=crossing)
        place = along[:, corner] + share * (along[:, other] - along[:, corner])
        begins = np.where(crossing, np.minimum(begins, place), begins)
        ends = np.where(crossing, np.maximum(ends, place), ends)
    ahead = ends > np.maximum(begins, 0.0)
    if not ahead.any():
        return None
    order = np.argsort(begins[ahead], kind="stable")
    begins, ends = begins[ahead][order], np.maximum.accumulate(ends[ahead][order])
    apart = np.flatnonzero(begins[1:] > ends[:-1] + 1e-6 * ends[-1])
    last = int(apart[0]) if len(apart) else len(ends) - 1
    return float(max(begins[0], 0.0) + ends[last]) / 2
