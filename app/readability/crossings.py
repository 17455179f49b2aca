"""Where lines of different hyperedges cross in a picture, and at what angle (Numba)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.clearance.box_tree import meeting, plant

SAME = 1e-12
"""Places nearer to a line than this, over the largest coordinate, are on it: else rounding says
where lines cross that lie on each other, as those of upright tubes one behind the other do."""

RIGHT, UP = 0.6180339887, 0.7861513778
"""The way in which lines are moved that lie on others: one that few lines have."""

AT_ONCE = 8192
"""Straight lines looked at together: what they may cross has to be in memory at once."""


class Crossings(NamedTuple):
    """Crossings in a picture, sorted by their two lines.

    ``lines`` (c, 2): the smaller number first; ``places`` (c, 2); ``angles`` (c,) between the
    lines, radians, from 0 to a right angle.
    """

    lines: Indices
    places: Floats
    angles: Floats


def find_crossings(begins: Floats, ends: Floats, owners: Indices) -> Crossings:
    """All crossings of straight lines (s, 2) to (s, 2) that are of different ``owners`` (s,).

    Where lines meet at ends, as those of a polyline do, or where they lie on each other, the one of
    the larger owner counts as moved by next to nothing, always to the same side. So a polyline that
    crosses another one at a corner of both does so once, and one that touches another one does not
    cross it, or does so twice.

    >>> begins, ends = np.array([[-1.0, 0.0], [0.0, -1.0]]), np.array([[1.0, 0.0], [0.0, 1.0]])
    >>> found = find_crossings(begins, ends, np.array([0, 1]))
    >>> found.lines.tolist(), found.places.tolist(), np.degrees(found.angles).tolist()
    ([[0, 1]], [[0.0, 0.0]], [90.0])
    """
    pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *_pairs(begins, ends, owners)])
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    a, b = begins[pairs[:, 0]], begins[pairs[:, 1]]
    along, other = ends[pairs[:, 0]] - a, ends[pairs[:, 1]] - b
    sines = along[:, 0] * other[:, 1] - along[:, 1] * other[:, 0]
    cosines = (along * other).sum(axis=1)
    way = b - a
    ahead = way[:, 0] * other[:, 1] - way[:, 1] * other[:, 0]
    # Lines on each other cross where the second one begins.
    flat = sines == 0.0
    shares = np.where(flat, 0.0, ahead / np.where(flat, 1.0, sines))
    places = np.where(flat[:, None], b, a + np.clip(shares, 0.0, 1.0)[:, None] * along)
    return Crossings(pairs, places, np.arctan2(np.abs(sines), np.abs(cosines)))


def count_crossings(begins: Floats, ends: Floats, owners: Indices, acute: float) -> tuple[int, int]:
    """How many crossings `find_crossings` finds, and how many of them below the angle ``acute``.

    Takes memory for some of them only. ``acute`` in radians, up to a right angle.
    """
    total = few = 0
    for pairs in _pairs(begins, ends, owners):
        along = ends[pairs] - begins[pairs]
        one, other = along[:, 0], along[:, 1]
        sines = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
        angles = np.arctan2(sines, np.abs((one * other).sum(axis=1)))
        total += len(pairs)
        few += int((angles < acute).sum())
    return total, few


def _pairs(begins: Floats, ends: Floats, owners: Indices) -> Iterator[Indices]:
    """Pairs (k, 2) of lines that cross, some at a time; the smaller number comes first."""
    if len(begins) == 0:
        return
    boxes = np.zeros((len(begins), 8))
    boxes[:, :2], boxes[:, 4:6] = np.minimum(begins, ends), np.maximum(begins, ends)
    tree = plant(boxes)
    least = SAME * float(np.abs(boxes).max())
    everyone = np.ones(len(begins), dtype=np.bool_)
    for first in range(0, len(begins), AT_ONCE):
        asking = tree.order[first : first + AT_ONCE]
        near = meeting(tree, boxes, asking, (owners, owners), everyone)
        yield near[_cross(near, begins, ends, owners, least)]


@njit(cache=True, error_model="numpy", nogil=True)
def _cross(
    pairs: Indices, begins: Floats, ends: Floats, owners: Indices, least: float
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    found = np.zeros(len(pairs), dtype=np.bool_)
    for k in range(len(pairs)):
        # The second one is moved.
        i, j = pairs[k, 0], pairs[k, 1]
        if owners[i] > owners[j]:
            i, j = j, i
        a, b, c, d = begins[i], ends[i], begins[j], ends[j]
        found[k] = _left(a, b, c, True, least) != _left(a, b, d, True, least) and (
            _left(c, d, a, False, least) != _left(c, d, b, False, least)
        )
    return found


@njit(cache=True, error_model="numpy", inline="always")
def _left(a: Floats, b: Floats, c: Floats, moved: bool, least: float) -> bool:
    """Whether c is to the left of the line from a to b.

    Where it is nearer than ``least`` to it: whether it would be if c were ``moved`` by next to
    nothing, or else if the line was.
    """
    x, y = b[0] - a[0], b[1] - a[1]
    side = x * (c[1] - a[1]) - y * (c[0] - a[0])
    if abs(side) > least * (abs(x) + abs(y)):
        return bool(side > 0.0)
    return bool((x * UP - y * RIGHT > 0.0) == moved)
