"""Which vertical trunk stands left of which in a channel, and which of them dodge (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.placement.layers.crossings import left_of, reaches

STRAIGHT = -1
"""The track of a group that needs no trunk."""

APART = 1.8
"""Rows between two trunks in one track: room for the corners of both."""


@njit(cache=True)
def tracks(
    channel_starts: Indices, starts: Indices, middles: Indices, heights: Floats
) -> tuple[Indices, Indices, int]:
    """Tracks (g,), from left to right in each channel; dodges (g,); and how often nets cross.

    Where an end on the left of a channel is level with one of another net on the right, the trunk
    of the first stands left of the other's. What cannot be in any order so, dodges: it runs in
    front in this channel, the k-th of a channel in the k-th depth (0: none).
    """
    groups = len(starts) - 1
    found = np.full(groups, STRAIGHT, np.int64)
    dodges = np.zeros(groups, np.int64)
    low = np.empty(groups)
    high = np.empty(groups)
    for group in range(groups):
        reaches(group, starts, heights, low, high)
    crossings = 0
    for channel in range(len(channel_starts) - 1):
        first, end = channel_starts[channel], channel_starts[channel + 1]
        _order(first, end, starts, middles, heights, low, high, found, dodges)
        crossings += _count(first, end, starts, middles, heights, low, high, found)
    return found, dodges, crossings


@njit(cache=True)
def _order(
    first: int, end: int, starts: Indices, middles: Indices, heights: Floats, low: Floats,
    high: Floats, found: Indices, dodges: Indices,
) -> None:  # fmt: skip
    """Write tracks and dodges of the groups of one channel."""
    count = 0
    members = np.empty(end - first, np.int64)
    for group in range(first, end):
        if high[group] > low[group] or starts[group + 1] - starts[group] > 2:
            members[count] = group
            count += 1
    if count == 0:
        return
    members = members[:count]
    must = np.zeros((count, count), np.bool_)
    prefers = np.zeros((count, count), np.int64)
    for i in range(count):
        for j in range(count):
            one, other = members[i], members[j]
            must[i, j] = i != j and _meet(one, other, starts, middles, heights)
            if i < j and high[one] > low[other] and high[other] > low[one]:
                difference = left_of(one, other, starts, middles, heights, low, high) - left_of(
                    other, one, starts, middles, heights, low, high
                )
                prefers[i, j], prefers[j, i] = difference, -difference
    placed = _sorted(members, must, prefers, high, dodges)
    _share(members, placed, must, prefers, low, high, found)


@njit(cache=True)
def _sorted(
    members: Indices, must: Flags, prefers: Indices, high: Floats, dodges: Indices
) -> Indices:
    """Places in ``members`` of groups from left to right: those next that nobody must precede.

    Of these, the one with the fewest crossings, then the highest. Where there is none, the one that
    the fewest must precede dodges.
    """
    count = len(members)
    waits = np.sum(must.astype(np.int64), axis=0)
    scores = np.sum(prefers, axis=1)
    is_done = np.zeros(count, np.bool_)
    placed = np.empty(count, np.int64)
    dodged = 0
    for place in range(count):
        best = -1
        for i in range(count):
            if is_done[i]:
                continue
            if best < 0 or (waits[i], scores[i], high[members[i]]) < (
                waits[best], scores[best], high[members[best]],
            ):  # fmt: skip
                best = i
        if waits[best] > 0:
            dodged += 1
            dodges[members[best]] = dodged
        is_done[best] = True
        placed[place] = best
        for j in range(count):
            waits[j] -= must[best, j]
            scores[j] -= prefers[j, best]
    return placed


@njit(cache=True)
def _meet(one: int, other: int, starts: Indices, middles: Indices, heights: Floats) -> bool:
    """Whether an end of ``one`` on the left is level with one of the ``other`` on the right."""
    for t in range(starts[one], middles[one]):
        for u in range(middles[other], starts[other + 1]):
            if heights[t] == heights[u]:
                return True
    return False


@njit(cache=True)
def _share(
    members: Indices, placed: Indices, must: Flags, prefers: Indices, low: Floats, high: Floats,
    found: Indices,
) -> None:  # fmt: skip
    """Put trunks into the leftmost tracks that their order and their neighbours there allow."""
    for place in range(len(placed)):
        i = placed[place]
        one = members[i]
        track = 0
        for before in range(place):
            j = placed[before]
            other = members[j]
            meets = low[one] - APART < high[other] and low[other] - APART < high[one]
            if meets or must[i, j] or must[j, i] or prefers[j, i] < 0:
                track = max(track, found[other] + 1)
        found[one] = track


@njit(cache=True)
def _count(
    first: int, end: int, starts: Indices, middles: Indices, heights: Floats, low: Floats,
    high: Floats, found: Indices,
) -> int:  # fmt: skip
    """How often ends and trunks of different groups of one channel cross."""
    crossings = 0
    for one in range(first, end):
        for other in range(first, end):
            if other == one or found[other] == STRAIGHT:
                continue
            for t in range(starts[one], starts[one + 1]):
                # An end on the left meets what is left of its own trunk, and so on.
                is_left = t < middles[one]
                meets = (found[one] == STRAIGHT and is_left) or (
                    found[one] != STRAIGHT
                    and found[one] != found[other]
                    and (found[other] < found[one]) == is_left
                )
                crossings += meets and low[other] < heights[t] < high[other]
    return crossings
