"""Items that overlap, or are too near to each other, are moved apart."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.placement.stress.pairs import Progress

GAP, LABEL_GAP = 0.9, 0.5
"""Between bodies, and between a label and anything else; document units."""

STEPS = 500
"""Of moving all apart at once."""

SKIN = 1.0
"""Things so much farther apart than they must be are not looked at again until one has gone half of
that."""

OVER = 1.3
"""Corrections are taken so many times, over the square root of their number."""

SLACK = 1e-3
"""So much farther than it must things are moved apart."""

RING, ON_RING = 0.25, 24
"""From one ring of places to the next, where room is sought for one thing; and places on each."""


class Boxes(NamedTuple):
    """b boxes of n items: corners ``lows`` and ``highs`` (b, d) relative to their items.

    ``owners`` (b,) are the items, ``are_bodies`` (b,) tells bodies from labels.
    """

    lows: Floats
    highs: Floats
    owners: Indices
    are_bodies: Flags

    def of_items(self, items: Indices) -> Boxes:
        """The boxes of ``items`` (k,) alone, ascending, numbered from 0."""
        numbers = np.full(int(self.owners.max(initial=-1)) + 1, -1)
        items = items[items < len(numbers)]
        numbers[items] = np.arange(len(items))
        kept = numbers[self.owners] >= 0
        return Boxes(
            self.lows[kept],
            self.highs[kept],
            numbers[self.owners[kept]],
            self.are_bodies[kept],
        )


def move_apart(x: Floats, boxes: Boxes, free: Flags, progress: Progress) -> None:
    """Move the items at ``x`` (n, d) that are ``free`` (n,) so that no two are too near, in place.

    All are pushed apart along the axis along which they need to go least. What still is too near
    to something after `STEPS` goes to the nearest place that is free.
    """
    if len(boxes.owners) == 0 or not free.any():
        return
    step = 0
    while step < STEPS:
        progress()
        pairs = _candidates(x, boxes, free)
        taken, is_done = _push(x, boxes, free, pairs, STEPS - step)
        if is_done:
            return
        step += taken
    progress()
    _settle(x, boxes, free)


def are_near(x: Floats, boxes: Boxes) -> Flags:
    """Which items at ``x`` (n, d) are nearer to another one than the gaps, (n,)."""
    return np.asarray(_near(x, boxes))


@njit(cache=True, error_model="numpy")
def _needed(first: bool, second: bool) -> float:
    return GAP if first and second else LABEL_GAP


@njit(cache=True, error_model="numpy")
def _candidates(x: Floats, boxes: Boxes, free: Flags) -> Indices:
    """Pairs (p, 2) of boxes that may come too near to each other while nothing goes far."""
    count, dimensions = len(boxes.owners), x.shape[1]
    room = GAP + SKIN
    lows, highs = np.empty_like(boxes.lows), np.empty_like(boxes.highs)
    for k in range(count):
        for axis in range(dimensions):
            lows[k, axis] = x[boxes.owners[k], axis] + boxes.lows[k, axis]
            highs[k, axis] = x[boxes.owners[k], axis] + boxes.highs[k, axis]
    order = np.argsort(lows[:, 0], kind="mergesort")
    found = np.empty((8 * count + 16, 2), dtype=np.int64)
    size = 0
    for rank in range(count):
        k = order[rank]
        i = boxes.owners[k]
        for later in range(rank + 1, count):
            m = order[later]
            if lows[m, 0] > highs[k, 0] + room:
                break
            j = boxes.owners[m]
            if i == j or not (free[i] or free[j]):
                continue
            if lows[m, -1] > highs[k, -1] + room or lows[k, -1] > highs[m, -1] + room:
                continue
            if lows[m, 1] > highs[k, 1] + room or lows[k, 1] > highs[m, 1] + room:
                continue
            if size == len(found):
                larger = np.empty((2 * size, 2), dtype=np.int64)
                larger[:size] = found
                found = larger
            found[size, 0], found[size, 1] = k, m
            size += 1
    return found[:size].copy()


@njit(cache=True, error_model="numpy")
def _push(x: Floats, boxes: Boxes, free: Flags, pairs: Indices, steps: int) -> tuple[int, bool]:
    """Take so many steps, or fewer where ``pairs`` (p, 2) may no longer be all that are near.

    How many were taken, and whether nothing is too near to anything.
    """
    dimensions = x.shape[1]
    sums, weights, start = np.zeros_like(x), np.zeros(len(x)), x.copy()
    for step in range(steps):
        worst = 0.0
        for row in range(len(pairs)):
            k, m = pairs[row, 0], pairs[row, 1]
            i, j = boxes.owners[k], boxes.owners[m]
            gap = _needed(boxes.are_bodies[k], boxes.are_bodies[m])
            lack, along, way = np.inf, 0, 1.0
            for axis in range(dimensions):
                shift = x[j, axis] - x[i, axis]
                after = shift + boxes.lows[m, axis] - boxes.highs[k, axis]
                before = boxes.lows[k, axis] - shift - boxes.highs[m, axis]
                is_after = after > before or (after == before and j > i)
                depth = gap - (after if is_after else before)
                if depth < lack:
                    lack, along, way = depth, axis, 1.0 if is_after else -1.0
            if lack <= 0.0:
                continue
            worst = max(worst, lack)
            push = way * (lack + SLACK)
            if free[i] and free[j]:
                push *= 0.5
            if free[i]:
                sums[i, along] -= push
                weights[i] += 1.0
            if free[j]:
                sums[j, along] += push
                weights[j] += 1.0
        if worst == 0.0:
            return step, True
        farthest = 0.0
        for i in range(len(x)):
            if weights[i] > 0.0:
                share = OVER / np.sqrt(weights[i]) if weights[i] > 1.0 else 1.0
                square = 0.0
                for axis in range(dimensions):
                    x[i, axis] += share * sums[i, axis]
                    sums[i, axis] = 0.0
                    square += (x[i, axis] - start[i, axis]) ** 2
                weights[i] = 0.0
                farthest = max(farthest, square)
        if np.sqrt(farthest) > 0.5 * SKIN:
            return step + 1, False
    return steps, False


@njit(cache=True, error_model="numpy")
def _meets(x: Floats, boxes: Boxes, k: int, m: int) -> bool:
    gap = _needed(boxes.are_bodies[k], boxes.are_bodies[m]) - 1e-9
    i, j = boxes.owners[k], boxes.owners[m]
    for axis in range(x.shape[1]):
        away = x[j, axis] - x[i, axis]
        if away + boxes.lows[m, axis] - boxes.highs[k, axis] >= gap:
            return False
        if boxes.lows[k, axis] - away - boxes.highs[m, axis] >= gap:
            return False
    return True


@njit(cache=True, error_model="numpy")
def _near(x: Floats, boxes: Boxes) -> Flags:
    count = len(boxes.owners)
    found = np.zeros(len(x), dtype=np.bool_)
    lows = boxes.lows[:, 0] + x[boxes.owners, 0]
    highs = boxes.highs[:, 0] + x[boxes.owners, 0]
    order = np.argsort(lows, kind="mergesort")
    for rank in range(count):
        k = order[rank]
        for later in range(rank + 1, count):
            m = order[later]
            if lows[m] > highs[k] + GAP:
                break
            if boxes.owners[k] != boxes.owners[m] and _meets(x, boxes, k, m):
                found[boxes.owners[k]] = True
                found[boxes.owners[m]] = True
    return found


@njit(cache=True, error_model="numpy")
def _settle(x: Floats, boxes: Boxes, free: Flags) -> None:
    """Put what is too near to something else where there is room, one after another, in place."""
    waits = _near(x, boxes) & free
    for item in range(len(x)):
        if not waits[item]:
            continue
        here = x[item].copy()
        ring = 0
        while True:
            found = False
            places = 1 if ring == 0 else ON_RING
            for place in range(places):
                angle = 2.0 * np.pi * (place + 0.5 * (ring % 2)) / ON_RING
                x[item, 0] = here[0] + RING * ring * np.cos(angle)
                x[item, -1] = here[-1] + RING * ring * np.sin(angle)
                found = True
                for k in range(len(boxes.owners)):
                    if boxes.owners[k] != item:
                        continue
                    for m in range(len(boxes.owners)):
                        other = boxes.owners[m]
                        if other != item and not waits[other] and _meets(x, boxes, k, m):
                            found = False
                            break
                    if not found:
                        break
                if found:
                    break
            if found:
                break
            ring += 1 + ring // 16
        waits[item] = False
