"""Free room beside what stands already."""

from __future__ import annotations

import numpy as np

from app.arrays import Flags, Floats
from app.placement.rooms import ENDLESS, TOUCHING
from app.placement.rows import ASPECT, THIN, Arrangement
from app.placement.sized import Place

MOST = 200
"""Neighbours beside which room is sought, the last ones; where there are more, it is also sought
at the edges of all."""

WILD = 3.0
"""How bad a whole may become to stay within its room, over what is dense and of good proportions:
a tray grows to five times its width between its neighbours, and no further."""


def beside(
    taken: Floats,
    size: Place,
    gap: float,
    arrangement: Arrangement,
    room: Floats = ENDLESS,
    near: Place | None = None,
) -> Place:
    """Centre of a free place for a rectangle of ``size`` (width, depth).

    ``taken`` (k, 4), at least one, are left, near, right and far edges of rectangles from which it
    keeps a ``gap``. Of the places to the right of each and before each, it is the one that makes
    the smallest and best proportioned whole, or is the nearest to where it stood, ``near``; in a
    row or a column, the one behind the last. If it can, it stays within ``room`` (4,), to the left
    of others or behind them if need be, unless that makes a bad whole.

    >>> beside(np.array([[0.0, 0.0, 1.0, 1.0]]), (1.0, 1.0), 0.5, "row")
    (2.0, 0.5)
    """
    width, depth = size
    left, low = taken[:, :2].min(axis=0)
    right, far = taken[:, 2:].max(axis=0)
    if arrangement == "row":
        last = taken[np.argmax(taken[:, 2])]
        return float(right + gap + width / 2), float((last[1] + last[3]) / 2)
    if arrangement == "column":
        last = taken[np.argmin(taken[:, 1])]
        return float((last[0] + last[2]) / 2), float(low - gap - depth / 2)
    close = taken[-MOST:]
    whole = np.array([left, low, right, far])
    usual = np.concatenate(
        [
            np.column_stack([close[:, 2] + gap, close[:, 3]]),
            np.column_stack([close[:, 0], close[:, 1] - gap]),
            [[right + gap, far], [left, low - gap]],
        ]
    )
    other = np.concatenate(
        [
            np.column_stack([close[:, 0] - gap - width, close[:, 3]]),
            np.column_stack([close[:, 0], close[:, 3] + gap + depth]),
            [[left - gap - width, far], [left, far + gap + depth]],
        ]
    )
    places = _from_corners(usual, size)
    best, _ = _best(places[~_overlap(places, taken, gap)], whole, gap, near)
    sizes = np.concatenate([taken[:, 2:] - taken[:, :2], [size]]) + gap
    dense = float(sizes.prod(axis=1).sum())
    most = max(WILD * dense, float(_cost(right - left, far - low, gap)))
    for corners in (usual, other) if near is None else (np.concatenate([usual, other]),):
        places = _from_corners(corners, size)
        places = places[~_overlap(places, taken, gap)]
        places = places[_fit(places, room)]
        if len(places):
            place, cost = _best(places, whole, gap, near)
            if near is not None or cost <= most + TOUCHING:
                return place
    return best


def overlaps(rectangle: Floats, others: Floats, gap: float = 0.0) -> bool:
    """Whether ``rectangle`` (4,) is nearer than ``gap`` to any of ``others`` (k, 4)."""
    return bool(_overlap(rectangle[None], others, gap)[0])


def fits(rectangle: Floats, room: Floats) -> bool:
    """Whether ``rectangle`` (4,) lies within ``room`` (4,)."""
    return bool(_fit(rectangle[None], room)[0])


def _from_corners(corners: Floats, size: Place) -> Floats:
    """Rectangles (m, 4) of one size by their left far corners (m, 2)."""
    left, far = corners[:, 0], corners[:, 1]
    return np.column_stack([left, far - size[1], left + size[0], far])


def _best(places: Floats, whole: Floats, gap: float, near: Place | None) -> tuple[Place, float]:
    """The centre of the best of ``places`` (m, 4), and what it costs."""
    wide = np.maximum(places[:, 2], whole[2]) - np.minimum(places[:, 0], whole[0])
    deep = np.maximum(places[:, 3], whole[3]) - np.minimum(places[:, 1], whole[1])
    centers = (places[:, :2] + places[:, 2:]) / 2
    # A new place far away is as bad as a whole that is so much wider or deeper.
    cost = _cost(wide, deep, gap) if near is None else np.hypot(*(centers - near).T) + wide + deep
    best = np.argmin(np.round(cost, 9))
    x, y = centers[best].tolist()
    return (x, y), float(cost[best])


def _cost(wide: Floats, deep: Floats, gap: float) -> Floats:
    """How bad wholes of such widths and depths (m,) are: large, or out of proportion."""
    aspect = np.maximum(wide, THIN) / np.maximum(deep, THIN)
    out = np.maximum(aspect / ASPECT, ASPECT / aspect) ** 0.7
    return np.asarray((wide + gap) * (deep + gap) * out)


def _fit(places: Floats, room: Floats) -> Flags:
    """Which of ``places`` (m, 4) lie within ``room`` (4,)."""
    low = (places[:, :2] >= room[:2] - TOUCHING).all(axis=1)
    return np.asarray(low & (places[:, 2:] <= room[2:] + TOUCHING).all(axis=1))


def _overlap(places: Floats, taken: Floats, gap: float) -> Flags:
    """Which of ``places`` (m, 4) are nearer than ``gap`` to any of ``taken`` (k, 4)."""
    room = gap - TOUCHING
    free = np.zeros((len(places), len(taken)), dtype=np.bool_)
    for axis in (0, 1):
        free |= places[:, None, axis] >= taken[None, :, axis + 2] + room
        free |= places[:, None, axis + 2] <= taken[None, :, axis] - room
    return np.asarray(~free.all(axis=1))
