"""Pairs of nodes whose distances are wanted: all, or those with pivots where there are many."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.placement.stress.star import Star, distances_from

MOST = 1200
"""Nodes of a component for all of whose pairs there is time."""

PIVOTS = 100

AT_ONCE = 2_000_000
"""Distances between two reports of progress."""

Progress = Callable[[], None]
"""Told that work goes on. May raise to end it."""


@dataclass(frozen=True, slots=True, eq=False)
class Pairs:
    """k pairs of nodes, ``first`` and ``second`` (k,), wanted at ``distances`` (k,).

    Their ``weights`` (k,) are those of squared differences from these.
    """

    first: Indices
    second: Indices
    distances: Floats
    weights: Floats


def pairs_of(star: Star, progress: Progress) -> Pairs:
    """What is wanted of the nodes of a component, of two or more.

    Weights are one over the squares of distances. With pivots, each stands for all that is nearer
    to it than to another one (Ortmann, Klimenta and Brandes 2017).
    """
    count = len(star.starts) - 1
    if count > MOST:
        return _with_pivots(star, progress)
    rows = max(AT_ONCE // count, 1)
    parts = []
    for begin in range(0, count, rows):
        progress()
        parts.append(_from(star, np.arange(begin, min(begin + rows, count))))
    first, second = np.triu_indices(count, 1)
    distances = np.concatenate(parts)[first, second]
    return Pairs(first, second, distances, 1.0 / distances**2)


def _with_pivots(star: Star, progress: Progress) -> Pairs:
    count = len(star.starts) - 1
    pivots = np.empty(PIVOTS, dtype=np.int64)
    distances = np.empty((PIVOTS, count))
    nearest = np.full(count, np.inf)
    pivot = 0
    for number in range(PIVOTS):
        progress()
        pivots[number] = pivot
        distances[number] = _from(star, np.array([pivot]))[0]
        nearest = np.minimum(nearest, distances[number])
        pivot = int(nearest.argmax())
    regions = np.bincount(distances.argmin(axis=0), minlength=PIVOTS)
    first, second = np.repeat(pivots, count), np.tile(np.arange(count), PIVOTS)
    wanted, weights = distances.ravel(), np.repeat(regions, count).astype(np.float64)
    other = first != second
    spokes = np.repeat(np.arange(count), np.diff(star.starts))
    once = spokes < star.neighbours
    wanted = np.concatenate([wanted[other], star.lengths[once]])
    weights = np.concatenate([weights[other], np.ones(int(once.sum()))])
    return Pairs(
        np.concatenate([first[other], spokes[once]]),
        np.concatenate([second[other], star.neighbours[once]]),
        wanted,
        weights / wanted**2,
    )


def _from(star: Star, sources: Indices) -> Floats:
    return np.asarray(distances_from(star.starts, star.neighbours, star.lengths, sources))
