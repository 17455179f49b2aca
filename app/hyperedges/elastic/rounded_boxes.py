"""Rounded boxes of items, and how they push the segments of chains away (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.obstacles import Obstacles
from app.hyperedges.elastic.capsules import LEAST_SHARE
from app.placement.placement import Placement

PLACES = (0.5, 0.0, 1.0, 0.25, 0.75)
"""Places of a segment that are looked at, as shares of its length, beside the nearest."""

SOFTLY = 0.5
"""A label pushes with this share of an item's body."""

AWAY = 0.3
"""Cosine to the way from item to label below which a push is turned into it."""


ACROSS = 0.05
"""Sine of the angle to a segment from which on a way out of a box counts as across it."""


class Boxes(NamedTuple):
    """m boxes as `app.hyperedges.clearance.obstacles.Obstacles`, labels as capsules.

    A box as thin as a label's can be passed through; a capsule always has a way out. ``is_label``
    (m,), and ``outwards`` (m, 3): from the middle of the item to its label, 0 elsewhere.
    """

    centers: Floats
    rotations: Floats
    halves: Floats
    roundings: Floats
    is_label: Flags
    outwards: Floats


def boxes_of(obstacles: Obstacles, placement: Placement) -> Boxes:
    """The boxes of ``obstacles``, which are those of ``placement``, to push with."""
    items, is_label = obstacles.items, obstacles.is_label
    halves, roundings = obstacles.halves.copy(), obstacles.roundings.copy()
    rows = np.flatnonzero(is_label)
    roundings[rows] += np.hypot(halves[rows, 1], halves[rows, 2])
    halves[rows, 1:] = 0.0
    outwards = np.zeros((len(items), 3))
    axes = obstacles.rotations[rows, :, 0]
    way = obstacles.centers[rows] - placement.centers[items[rows]]
    way -= np.einsum("ij,ij->i", way, axes)[:, None] * axes
    lengths = np.linalg.norm(way, axis=1)
    outwards[rows] = way / np.maximum(lengths, 1e-9)[:, None]
    return Boxes(obstacles.centers, obstacles.rotations, halves, roundings, is_label, outwards)


@njit(cache=True, error_model="numpy")
def repel(
    x: Floats,
    segments: Indices,
    near: Indices,
    exempt: Floats,
    boxes: Boxes,
    rooms: Floats,
    half: float,
    beside: Floats,
    free: Floats,
    size: float,
    sums: Floats,
    weights: Floats,
) -> None:
    """Add what moves segments away from boxes, ``near`` (n, 2) pairs of both.

    As `app.hyperedges.elastic.capsules.separate`; a segment needs its room and ``half`` of the
    clearance. Within ``exempt`` (n, 4), a place and a radius, the box does not count.
    """
    local, way, along = np.empty(3), np.empty(3), np.empty(3)
    for row in range(len(near)):
        k, o = near[row, 0], near[row, 1]
        a, b = segments[k, 0], segments[k, 1]
        need = boxes.roundings[o] + (rooms[k] + half) * size + max(beside[a], beside[b])
        worst, at, length = 0.0, 0.0, 0.0
        for axis in range(3):
            along[axis] = x[b, axis] - x[a, axis]
            length += along[axis] * along[axis]
        for axis in range(3):
            along[axis] /= max(np.sqrt(length), 1e-9)
        for place in range(len(PLACES) + 1):
            s = PLACES[place] if place < len(PLACES) else _nearest(x, a, b, boxes, o)
            square = 0.0
            for axis in range(3):
                there = x[a, axis] + s * (x[b, axis] - x[a, axis])
                square += (there - exempt[row, axis]) ** 2
                local[axis] = there - boxes.centers[o, axis]
            if square < exempt[row, 3] * exempt[row, 3]:
                continue
            lack = need - _outside(boxes, o, along, local)
            if lack > worst:
                worst, at = lack, s
                way[:] = local
        if worst == 0.0:
            continue
        if boxes.is_label[o]:
            worst *= SOFTLY
            _turn_outwards(way, boxes.outwards[o])
        wa, wb = (1.0 - at) * free[a], at * free[b]
        total = wa * (1.0 - at) + wb * at
        if total <= 0.0:
            continue
        total = max(total, LEAST_SHARE)
        for axis in range(3):
            sums[a, axis] += wa / total * worst * way[axis]
            sums[b, axis] += wb / total * worst * way[axis]
        weights[a] += wa
        weights[b] += wb


@njit(cache=True, error_model="numpy")
def _outside(boxes: Boxes, o: int, along: Floats, place: Floats) -> float:
    """How far ``place`` (3,), from the box's centre, is outside the box: less than 0 within.

    It becomes the unit way out. From within that is the shortest one across the unit direction
    ``along`` (3,) of the segment, so that a chain through a box leaves it on one side.
    """
    rotation, half = boxes.rotations[o], boxes.halves[o]
    square, shortest, depth, out = 0.0, np.inf, 0.0, 0
    x, y, z = place[0], place[1], place[2]
    place[:] = 0.0
    for axis in range(3):
        there = rotation[0, axis] * x + rotation[1, axis] * y + rotation[2, axis] * z
        beyond = there - min(max(there, -half[axis]), half[axis])
        square += beyond * beyond
        cosine = 0.0
        for k in range(3):
            place[k] += beyond * rotation[k, axis]
            cosine += along[k] * rotation[k, axis]
        way = half[axis] - abs(there) + boxes.roundings[o] + 1e-9
        way /= max(np.sqrt(max(1.0 - cosine * cosine, 0.0)), ACROSS)
        if way < shortest:
            shortest, depth = way, half[axis] - abs(there)
            out = axis if there >= 0.0 else axis + 3
    distance = np.sqrt(square)
    if distance > 1e-9:
        for k in range(3):
            place[k] /= distance
        return float(distance)
    for k in range(3):
        place[k] = rotation[k, out % 3] * (1.0 if out < 3 else -1.0)
    return float(-depth)


@njit(cache=True, error_model="numpy")
def _nearest(x: Floats, a: int, b: int, boxes: Boxes, o: int) -> float:
    """Where a segment is nearest to the longest axis of a box, as a share of its length."""
    half, rotation = boxes.halves[o], boxes.rotations[o]
    long = 0
    for axis in range(1, 3):
        if half[axis] > half[long]:
            long = axis
    uu = uv = uw = vw = 0.0
    vv = 4.0 * half[long] * half[long]
    for axis in range(3):
        u = x[b, axis] - x[a, axis]
        v = 2.0 * half[long] * rotation[axis, long]
        w = x[a, axis] - boxes.centers[o, axis] + 0.5 * v
        uu += u * u
        uv += u * v
        uw += u * w
        vw += v * w
    uu += 1e-18
    s = min(max(-uw / uu, 0.0), 1.0)
    if vv <= 0.0:
        return s
    over = uu * vv - uv * uv
    if over > 1e-9 * uu * vv:
        s = min(max((uv * vw - uw * vv) / over, 0.0), 1.0)
    t = (uv * s + vw) / vv
    if t < 0.0:
        s = min(max(-uw / uu, 0.0), 1.0)
    elif t > 1.0:
        s = min(max((uv - uw) / uu, 0.0), 1.0)
    return s


@njit(cache=True, error_model="numpy")
def _turn_outwards(way: Floats, outwards: Floats) -> None:
    """Turn a push away from the item, where it leads into the nook between it and its label."""
    along = way[0] * outwards[0] + way[1] * outwards[1] + way[2] * outwards[2]
    if along >= AWAY:
        return
    square = 0.0
    for axis in range(3):
        way[axis] += (AWAY + 0.4 - along) * outwards[axis]
        square += way[axis] * way[axis]
    for axis in range(3):
        way[axis] /= max(np.sqrt(square), 1e-9)
