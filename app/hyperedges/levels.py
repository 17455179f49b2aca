"""Levels for footprints, so that those which overlap have different ones (Numba)."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.footprints import ALL, SOME, Footprints, overlap, share

LEVELS = 1024
"""So many levels in a row are told apart. Who finds all of them taken, shares."""

WORDS = LEVELS // 64

Bits: TypeAlias = NDArray[np.uint64]
"""Sets of levels; level n is bit n modulo `LEVELS`."""


@njit(cache=True)
def assign(footprints: Footprints, wishes: Indices, tops: Indices, order: Indices) -> Indices:
    """Levels (n,): for one footprint after another the lowest free one from its wish on.

    ``wishes`` and ``tops`` (n,): the lowest level that each may get, and the highest, which it
    shares where all are taken. They are less than `LEVELS` apart. Footprints not in ``order`` come
    first and take all levels from their wish to their top.
    """
    rectangles = footprints.rectangles
    levels = wishes.copy()
    # Which levels are taken below each node, and by each footprint.
    taken = np.zeros((len(footprints.children), WORDS), np.uint64)
    bits = np.zeros((len(wishes), WORDS), np.uint64)
    given = np.ones(len(wishes), np.bool_)
    given[order] = False
    for k in range(len(given)):
        if not given[k]:
            continue
        for level in range(wishes[k], tops[k] + 1):
            _take(footprints, taken, bits, k, level)
    stack = np.empty(len(footprints.children) + 1, np.int64)
    used = np.empty(WORDS, np.uint64)
    for k in order:
        _find_used(footprints, taken, bits, rectangles[k], stack, used)
        level = wishes[k]
        while level < tops[k] and _has(used, level):
            level += 1
        levels[k] = level
        _take(footprints, taken, bits, k, level)
    return levels


@njit(cache=True)
def _has(used: Bits, level: int) -> bool:
    bit = np.uint64(level % LEVELS)
    word = used[bit >> np.uint64(6)]
    return bool((word >> (bit & np.uint64(63))) & np.uint64(1))


@njit(cache=True)
def _adds(some: Bits, used: Bits) -> bool:
    news = np.uint64(0)
    for word in range(WORDS):
        news |= some[word] & ~used[word]
    return bool(news)


@njit(cache=True)
def _take(footprints: Footprints, taken: Bits, bits: Bits, k: int, level: int) -> None:
    bit = np.uint64(level % LEVELS)
    word, mask = bit >> np.uint64(6), np.uint64(1) << (bit & np.uint64(63))
    bits[k, word] |= mask
    node = footprints.leaves[k]
    while node >= 0:
        taken[node, word] |= mask
        node = footprints.parents[node]


@njit(cache=True)
def _find_used(
    footprints: Footprints,
    taken: Bits,
    bits: Bits,
    rectangle: Floats,
    stack: Indices,
    used: Bits,
) -> None:
    """Write the levels taken by footprints that overlap a rectangle."""
    own, order, begins, ends, lows, highs, children, _, _ = footprints
    used[:] = np.uint64(0)
    stack[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = stack[waiting]
        if not _adds(taken[node], used):
            continue
        how_many = share(lows[node], highs[node], rectangle)
        if how_many == ALL:
            used |= taken[node]
        elif how_many == SOME and children[node] >= 0:
            stack[waiting] = children[node]
            stack[waiting + 1] = children[node] + 1
            waiting += 2
        elif how_many == SOME:
            for i in order[begins[node] : ends[node]]:
                if overlap(own[i], rectangle):
                    used |= bits[i]
