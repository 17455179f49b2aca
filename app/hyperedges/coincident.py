"""Points that lie at exactly the same place, found by hashing their coordinates (Numba).

Coincident points would spoil any search for neighbours: each is the nearest of all the others.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices


class Places(NamedTuple):
    """Places, each with a list of the living points that lie there, ascending.

    ``table`` (a power of two): the place in each bucket, or -1; a place is named by the first point
    that was there. ``heads``, ``tails``, ``sizes`` (n,) of places; ``following`` (n,) of points;
    ``crowds``: a heap of the first points of places with two or more, ``crowded`` (1,) of them;
    ``place_of`` (n,), ``alive`` (n,) of points. ``dimensions`` (1,) coordinates count.
    """

    table: Indices
    heads: Indices
    tails: Indices
    sizes: Indices
    following: Indices
    crowds: Indices
    crowded: Indices
    place_of: Indices
    alive: NDArray[np.bool_]
    dimensions: Indices


@njit(cache=True)
def empty_places(capacity: int, dimensions: int) -> Places:
    """Places for points numbered below ``capacity``."""
    buckets = 16
    while buckets < 2 * capacity:
        buckets *= 2
    return Places(
        np.full(buckets, -1, np.int64),
        np.empty(capacity, np.int64),
        np.empty(capacity, np.int64),
        np.zeros(capacity, np.int64),
        np.empty(capacity, np.int64),
        np.empty(capacity, np.int64),
        np.zeros(1, np.int64),
        np.empty(capacity, np.int64),
        np.zeros(capacity, np.bool_),
        np.array([dimensions]),
    )


@njit(cache=True)
def _bucket(places: Places, points: Floats, i: int) -> int:
    """The bucket of the place of point i, or the empty one where it belongs."""
    dimensions = places.dimensions[0]
    bits = points[i].view(np.uint64)
    mixed = np.uint64(0)
    for axis in range(dimensions):
        # The finalizer of MurmurHash3 (Appleby): coordinates differ in few, high bits.
        mixed = (mixed ^ bits[axis]) * np.uint64(0xFF51AFD7ED558CCD)
        mixed ^= mixed >> np.uint64(33)
        mixed *= np.uint64(0xC4CEB9FE1A85EC53)
        mixed ^= mixed >> np.uint64(33)
    mask = len(places.table) - 1
    bucket = int(np.int64(mixed & np.uint64(mask)))
    while places.table[bucket] >= 0:
        other = places.table[bucket]
        equal = True
        for axis in range(dimensions):
            equal = equal and points[i, axis] == points[other, axis]
        if equal:
            break
        bucket = (bucket + 1) & mask
    return bucket


@njit(cache=True)
def add_to_place(places: Places, points: Floats, i: int) -> None:
    """Point i, with a larger number than all before, comes to life.

    Its coordinates must not be -0.0, which is another pattern of bits for the same place.
    """
    bucket = _bucket(places, points, i)
    place = places.table[bucket]
    if place < 0:
        place = i
        places.table[bucket] = i
    places.alive[i] = True
    places.place_of[i] = place
    places.following[i] = -1
    if places.sizes[place] == 0:
        places.heads[place] = i
    else:
        places.following[places.tails[place]] = i
    places.tails[place] = i
    places.sizes[place] += 1
    if places.sizes[place] == 2:
        _push(places, places.heads[place])


@njit(cache=True)
def take_coincident(places: Places) -> tuple[int, int]:
    """The coincident pair with the smallest numbers, which dies; -1, -1 where there is none."""
    if places.crowded[0] == 0:
        return -1, -1
    first = _pop(places)
    place = places.place_of[first]
    second = places.following[first]
    places.alive[first] = False
    places.alive[second] = False
    places.heads[place] = places.following[second]
    places.sizes[place] -= 2
    if places.sizes[place] >= 2:
        _push(places, places.heads[place])
    return first, second


@njit(cache=True)
def _push(places: Places, i: int) -> None:
    crowds = places.crowds
    place = places.crowded[0]
    places.crowded[0] += 1
    while place > 0 and i < crowds[(place - 1) >> 1]:
        crowds[place] = crowds[(place - 1) >> 1]
        place = (place - 1) >> 1
    crowds[place] = i


@njit(cache=True)
def _pop(places: Places) -> int:
    crowds = places.crowds
    top = int(crowds[0])
    places.crowded[0] -= 1
    count = places.crowded[0]
    last = crowds[count]
    place = 0
    while 2 * place + 1 < count:
        child = 2 * place + 1
        if child + 1 < count and crowds[child + 1] < crowds[child]:
            child += 1
        if crowds[child] >= last:
            break
        crowds[place] = crowds[child]
        place = child
    crowds[place] = last
    return top
