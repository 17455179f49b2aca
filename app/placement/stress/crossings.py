"""How many spokes of a star expansion cross on the plane."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices


@njit(cache=True, error_model="numpy")
def crossings_of(x: Floats, first: Indices, last: Indices) -> int:
    """Of straight lines between nodes at ``x`` (n, 2), from ``first`` to ``last`` (m,).

    Those that share a node do not cross.
    """
    count = len(first)
    lows = np.minimum(x[first, 0], x[last, 0])
    highs = np.maximum(x[first, 0], x[last, 0])
    order = np.argsort(lows, kind="mergesort")
    found = 0
    for rank in range(count):
        i = order[rank]
        a, b = x[last[i], 0] - x[first[i], 0], x[last[i], 1] - x[first[i], 1]
        for later in range(rank + 1, count):
            j = order[later]
            if lows[j] > highs[i]:
                break
            if first[i] == first[j] or last[i] == last[j]:
                continue
            c, d = x[last[j], 0] - x[first[j], 0], x[last[j], 1] - x[first[j], 1]
            turn = a * d - b * c
            if turn == 0.0:
                continue
            e, f = x[first[j], 0] - x[first[i], 0], x[first[j], 1] - x[first[i], 1]
            here, there = (e * d - f * c) / turn, (e * b - f * a) / turn
            if 0.0 < here < 1.0 and 0.0 < there < 1.0:
                found += 1
    return found
