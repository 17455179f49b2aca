"""In which order objects stand in their ranks: barycentre sweeps and exchanges (Numba).

As in Sugiyama, Tagawa and Toda, "Methods for Visual Understanding of Hierarchical System
Structures" (1981), over the heights of terminals rather than of objects.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.placement.layers.crossings import all_between, between
from app.placement.layers.terminals import LANE, Terminals

AIR = 1.2
"""Rows between an item and the next object, while the order is looked for."""

BESIDE = 0.5
"""Weight of terminals on the same side of a channel, over those across."""

BEYOND = 0.25
"""Weight, in every other pair of sweeps, of terminals across the channel that a sweep goes to."""


def order(
    terminals: Terminals, shuffled: Indices, sweeps: int, spaces: Floats
) -> tuple[Indices, int]:
    """Objects (m,), rank after rank and from the top down in each, and how often nets cross so.

    It starts with the objects in the order of ``shuffled`` (m,). ``spaces`` (m,): rows that each
    takes with the air below it.
    """
    within = np.empty(len(shuffled), dtype=np.int64)
    within[shuffled] = np.arange(len(shuffled))
    first = np.lexsort((within, terminals.object_ranks))
    rank_starts = np.searchsorted(
        terminals.object_ranks[first], np.arange(terminals.ranks + 1)
    ).astype(np.int64)
    found = first.copy()
    crossings = _sweep(
        found,
        rank_starts,
        terminals.group_starts,
        terminals.group_middles,
        terminals.channel_starts,
        terminals.group_channels,
        terminals.groups,
        terminals.objects,
        terminals.rows,
        terminals.by_object,
        terminals.object_starts,
        spaces,
        sweeps,
    )
    return found, crossings


def spaces_of(terminals: Terminals) -> Floats:
    """Rows (m,) that objects take, roughly."""
    return np.asarray(terminals.object_spans + np.where(terminals.object_nets == LANE, AIR, 1.0))


@njit(cache=True)
def _sweep(
    found: Indices, rank_starts: Indices, starts: Indices, middles: Indices,
    channel_starts: Indices, channels: Indices, groups: Indices, objects: Indices, rows: Indices,
    by_object: Indices, object_starts: Indices, spaces: Floats, sweeps: int,
) -> int:  # fmt: skip
    """Order ``found`` (m,) in place, and count the crossings."""
    ranks = len(rank_starts) - 1
    heights = np.empty(len(objects))
    for rank in range(ranks):
        _stand(found[rank_starts[rank] : rank_starts[rank + 1]], spaces, rows, by_object,
               object_starts, heights)  # fmt: skip
    best = found.copy()
    fewest_found = all_between(channel_starts, starts, middles, heights)
    for sweep in range(sweeps):
        forth = sweep % 2 == 0
        beyond = BEYOND if sweep % 4 > 1 else 0.0
        for step in range(ranks):
            rank = step if forth else ranks - 1 - step
            row = found[rank_starts[rank] : rank_starts[rank + 1]]
            keys = np.empty(len(row))
            for place in range(len(row)):
                keys[place] = _barycentre(
                    row[place], forth, beyond, starts, middles, groups, rows, by_object,
                    object_starts, heights,
                )  # fmt: skip
            row[:] = row[np.argsort(keys, kind="mergesort")]
            _stand(row, spaces, rows, by_object, object_starts, heights)
        if sweep < sweeps - 3 and sweep % 8 != 7:
            continue
        for rank in range(ranks):
            _exchange(
                found[rank_starts[rank] : rank_starts[rank + 1]], starts, middles, channels,
                groups, rows, by_object, object_starts, spaces, heights,
            )  # fmt: skip
        crossings = all_between(channel_starts, starts, middles, heights)
        if crossings < fewest_found:
            fewest_found = crossings
            best[:] = found
    found[:] = best
    return fewest_found


@njit(cache=True)
def _stand(
    row: Indices, spaces: Floats, rows: Indices, by_object: Indices, object_starts: Indices,
    heights: Floats,
) -> None:  # fmt: skip
    """Heights, in rows downwards, of the terminals of objects that stand one below another."""
    top = 0.0
    for o in row:
        for place in range(object_starts[o], object_starts[o + 1]):
            heights[by_object[place]] = top + rows[by_object[place]]
        top += spaces[o]


@njit(cache=True)
def _barycentre(
    o: int, forth: bool, beyond: float, starts: Indices, middles: Indices, groups: Indices,
    rows: Indices, by_object: Indices, object_starts: Indices, heights: Floats,
) -> float:  # fmt: skip
    """Where an object would be level with the terminals that its own are joined to."""
    total = weights = 0.0
    top = 0.0
    for place in range(object_starts[o], object_starts[o + 1]):
        t = by_object[place]
        top = heights[t] - rows[t]
        group = groups[t]
        is_left = t < middles[group]
        for other in range(starts[group], starts[group + 1]):
            if other == t:
                continue
            weight = BESIDE
            if (other < middles[group]) != is_left:
                # What is across on the left is joined to what is on the channel's right.
                weight = 1.0 if forth != is_left else beyond
            total += weight * (heights[other] - rows[t])
            weights += weight
    return total / weights if weights > 0.0 else top


@njit(cache=True)
def _exchange(
    row: Indices, starts: Indices, middles: Indices, channels: Indices, groups: Indices,
    rows: Indices, by_object: Indices, object_starts: Indices, spaces: Floats, heights: Floats,
) -> None:  # fmt: skip
    """Exchange neighbours in a rank as long as that makes crossings fewer, at most twice along."""
    for _ in range(2):
        changed = False
        for place in range(len(row) - 1):
            a, b = row[place], row[place + 1]
            before = _crossings_of(
                a, b, starts, middles, channels, groups, by_object, object_starts, heights
            )
            if before == 0:
                continue
            _move(b, -spaces[a], by_object, object_starts, heights)
            _move(a, spaces[b], by_object, object_starts, heights)
            after = _crossings_of(
                a, b, starts, middles, channels, groups, by_object, object_starts, heights
            )
            if after < before:
                row[place], row[place + 1] = b, a
                changed = True
            else:
                _move(b, spaces[a], by_object, object_starts, heights)
                _move(a, -spaces[b], by_object, object_starts, heights)
        if not changed:
            break
    # Sums of moves are not to the last bit what they would be anew.
    _stand(row, spaces, rows, by_object, object_starts, heights)


@njit(cache=True)
def _move(
    o: int, by: float, by_object: Indices, object_starts: Indices, heights: Floats
) -> None:  # fmt: skip
    for place in range(object_starts[o], object_starts[o + 1]):
        heights[by_object[place]] += by


@njit(cache=True)
def _crossings_of(
    a: int, b: int, starts: Indices, middles: Indices, channels: Indices, groups: Indices,
    by_object: Indices, object_starts: Indices, heights: Floats,
) -> int:  # fmt: skip
    """Crossings of the groups on one object with those on another: no others change with them.

    A group that has many terminals on an object counts as often, before and after an exchange.
    """
    found = 0
    for place in range(object_starts[a], object_starts[a + 1]):
        one = groups[by_object[place]]
        for at in range(object_starts[b], object_starts[b + 1]):
            other = groups[by_object[at]]
            if one != other and channels[one] == channels[other]:
                found += between(one, other, starts, middles, heights)
    return found
