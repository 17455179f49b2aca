"""Stress by stochastic gradient descent (Zheng, Pawar and Goodman 2019)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from app.arrays import Flags, Floats, Indices
from app.placement.stress.pairs import Pairs, Progress

PASSES = 25
"""Over all pairs."""

FINEST = 0.05
"""Step of the last pass for the pair of the largest weight, over that which satisfies it."""

SEED = 20190301
TINY = 1e-9


def descend(x: Floats, pairs: Pairs, free: Flags, progress: Progress) -> None:
    """Move nodes (n, d) to where the stress of ``pairs`` is least, in place.

    Only those ``free`` (n,) move. The same bits for the same input.
    """
    count = len(pairs.first)
    largest, least = float(pairs.weights.max()), float(pairs.weights.min())
    begin, end = 1.0 / least, FINEST / largest
    # Shuffled once, so that memory is read in its order; each pass begins elsewhere.
    order = _shuffled(count)
    first, second = pairs.first[order], pairs.second[order]
    distances, weights = pairs.distances[order], pairs.weights[order]
    for number in range(PASSES):
        progress()
        rate = begin * math.exp(math.log(end / begin) * number / (PASSES - 1))
        _pass(x, first, second, distances, weights, free, rate, number * count // PASSES)


@njit(cache=True, error_model="numpy")
def _shuffled(count: int) -> Indices:
    """The numbers from 0 to ``count`` in a random order, always the same."""
    order = np.arange(count)
    state = np.uint64(SEED)
    for last in range(count - 1, 0, -1):
        # A linear congruential generator, whose upper bits are random enough.
        state = state * np.uint64(6364136223846793005) + np.uint64(1442695040888963407)
        other = ((state >> np.uint64(32)) * np.uint64(last + 1)) >> np.uint64(32)
        order[last], order[other] = order[other], order[last]
    return order


@njit(cache=True, error_model="numpy")
def _pass(
    x: Floats,
    first: Indices,
    second: Indices,
    distances: Floats,
    weights: Floats,
    free: Flags,
    rate: float,
    begin: int,
) -> None:
    """Satisfy each pair a little, the pair ``begin`` first."""
    count = len(first)
    for step in range(count):
        row = begin + step
        if row >= count:
            row -= count
        i, j = first[row], second[row]
        movers = int(free[i]) + int(free[j])
        if movers == 0:
            continue
        square = 0.0
        for axis in range(x.shape[1]):
            square += (x[i, axis] - x[j, axis]) ** 2
        far = np.sqrt(square) + TINY
        share = min(1.0, weights[row] * rate) * (far - distances[row]) / (far * movers)
        for axis in range(x.shape[1]):
            move = share * (x[i, axis] - x[j, axis])
            if free[i]:
                x[i, axis] -= move
            if free[j]:
                x[j, axis] += move
