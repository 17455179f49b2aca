"""The order to paint in: what is behind first, each item in one go."""

from __future__ import annotations

import heapq
from collections import defaultdict

from app.arrays import Indices


def order(count: int, pairs: Indices, weights: Indices) -> list[int]:
    """All of 0 to ``count`` - 1 so that in each of ``pairs`` (k, 2) the first one comes first.

    Where that cannot be because they go round in a ring, those of little weight (k,) are broken.

    >>> import numpy as np
    >>> order(3, np.array([[2, 0], [0, 1]]), np.array([1, 1]))
    [2, 0, 1]
    """
    after: dict[int, dict[int, int]] = defaultdict(dict)
    held = [0] * count
    for (first, second), weight in zip(pairs.tolist(), weights.tolist(), strict=True):
        after[first][second] = after[first].get(second, 0) + weight
        held[second] += weight
    waiting = [(weight, number) for number, weight in enumerate(held)]
    heapq.heapify(waiting)
    done = [False] * count
    found: list[int] = []
    while waiting:
        weight, number = heapq.heappop(waiting)
        if done[number] or weight != held[number]:
            continue
        done[number] = True
        found.append(number)
        for second, less in after[number].items():
            if not done[second]:
                held[second] -= less
                heapq.heappush(waiting, (held[second], second))
    return found


def broken(places: list[int], pairs: Indices) -> list[tuple[int, int]]:
    """Those of ``pairs`` (k, 2) whose first one comes second, as ``places`` are."""
    return [(a, b) for a, b in pairs.tolist() if places[a] > places[b]]
