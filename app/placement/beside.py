"""Free room beside what stands already."""

from __future__ import annotations

import numpy as np

from app.arrays import Flags, Floats
from app.placement.rows import ASPECT, THIN, Arrangement
from app.placement.sized import Place

MOST = 200
"""Neighbours beside which room is sought, the last ones; where there are more, it is also sought
at the edges of all."""

TOUCHING = 1e-9
"""What rounding leaves between rectangles that touch."""


def beside(taken: Floats, size: Place, gap: float, arrangement: Arrangement) -> Place:
    """Centre of a free place for a rectangle of ``size`` (width, depth).

    ``taken`` (k, 4), at least one, are left, near, right and far edges of rectangles from which it
    keeps a ``gap``. Of the places to the right of each and before each, it is the one that makes
    the smallest and best proportioned whole; in a row or a column, the one behind the last.

    >>> beside(np.array([[0.0, 0.0, 1.0, 1.0]]), (1.0, 1.0), 0.5, "row")
    (2.0, 0.5)
    """
    width, depth = size
    left, near = taken[:, :2].min(axis=0)
    right, far = taken[:, 2:].max(axis=0)
    if arrangement == "row":
        last = taken[np.argmax(taken[:, 2])]
        return float(right + gap + width / 2), float((last[1] + last[3]) / 2)
    if arrangement == "column":
        last = taken[np.argmin(taken[:, 1])]
        return float((last[0] + last[2]) / 2), float(near - gap - depth / 2)
    close = taken[-MOST:]
    corners = np.concatenate(
        [
            np.column_stack([close[:, 2] + gap, close[:, 3]]),
            np.column_stack([close[:, 0], close[:, 1] - gap]),
            [[right + gap, far], [left, near - gap]],
        ]
    )
    far_corners = corners + np.array([width, -depth])
    places = np.column_stack([corners, far_corners])[:, [0, 3, 2, 1]]
    places = places[~_overlap(places, taken, gap)]
    wide = np.maximum(places[:, 2], right) - np.minimum(places[:, 0], left)
    deep = np.maximum(places[:, 3], far) - np.minimum(places[:, 1], near)
    aspect = np.maximum(wide, THIN) / np.maximum(deep, THIN)
    cost = (wide + gap) * (deep + gap) * np.maximum(aspect / ASPECT, ASPECT / aspect) ** 0.7
    best = places[np.argmin(np.round(cost, 9))]
    return float((best[0] + best[2]) / 2), float((best[1] + best[3]) / 2)


def overlaps(rectangle: Floats, others: Floats) -> bool:
    """Whether ``rectangle`` (4,) overlaps any of ``others`` (k, 4)."""
    return bool(_overlap(rectangle[None], others, 0.0)[0])


def _overlap(places: Floats, taken: Floats, gap: float) -> Flags:
    """Which of ``places`` (m, 4) are nearer than ``gap`` to any of ``taken`` (k, 4)."""
    room = gap - TOUCHING
    free = np.zeros((len(places), len(taken)), dtype=np.bool_)
    for axis in (0, 1):
        free |= places[:, None, axis] >= taken[None, :, axis + 2] + room
        free |= places[:, None, axis + 2] <= taken[None, :, axis] - room
    return np.asarray(~free.all(axis=1))
