"""On which side of a sheet each hyperedge passes."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.grouped import starts_of

ENDS = 0.02
"""Share of a line at its ends within which it crosses no other: there they meet."""

BEHIND = 1.0
"""So many more crossings may be behind the sheet than before it: there a tube hides no item."""

ROUNDS = 2


def sides_of(first: Floats, last: Floats, owners: Indices, count: int) -> Floats:
    """The sides (h,) of ``count`` hyperedges: 1 behind the sheet, -1 before it.

    Their trees' edges lead from ``first`` to ``last`` (c, 2) on the sheet; ``owners`` (c,),
    ascending, are their hyperedges. Long ones first, each goes where it crosses fewer others.
    """
    pairs = np.asarray(_crossing(first, last, owners)).reshape(-1, 2)
    lengths = np.bincount(owners, np.linalg.norm(last - first, axis=1), count)
    both = np.concatenate([pairs, pairs[:, ::-1]])
    both = both[np.argsort(both[:, 0], kind="stable")]
    starts = starts_of(np.bincount(both[:, 0], minlength=count))
    sides = np.zeros(count)
    for _ in range(ROUNDS):
        for number in np.argsort(-lengths, kind="stable").tolist():
            others = sides[both[starts[number] : starts[number + 1], 1]]
            before, behind = int((others < 0).sum()), int((others > 0).sum())
            sides[number] = 1.0 if behind <= before + BEHIND else -1.0
    return sides


@njit(cache=True, error_model="numpy")
def _crossing(first: Floats, last: Floats, owners: Indices) -> Indices:
    """Pairs (p, 2) of different owners, once for each crossing of their lines."""
    count = len(first)
    lows = np.minimum(first[:, 0], last[:, 0])
    highs = np.maximum(first[:, 0], last[:, 0])
    order = np.argsort(lows, kind="mergesort")
    found = np.empty((4 * count + 16, 2), dtype=np.int64)
    size = 0
    for rank in range(count):
        i = order[rank]
        a, b = last[i, 0] - first[i, 0], last[i, 1] - first[i, 1]
        for later in range(rank + 1, count):
            j = order[later]
            if lows[j] > highs[i]:
                break
            if owners[i] == owners[j]:
                continue
            c, d = last[j, 0] - first[j, 0], last[j, 1] - first[j, 1]
            turn = a * d - b * c
            if turn == 0.0:
                continue
            e, f = first[j, 0] - first[i, 0], first[j, 1] - first[i, 1]
            here, there = (e * d - f * c) / turn, (e * b - f * a) / turn
            if not (ENDS < here < 1.0 - ENDS and ENDS < there < 1.0 - ENDS):
                continue
            if size == len(found):
                larger = np.empty((2 * size, 2), dtype=np.int64)
                larger[:size] = found
                found = larger
            found[size, 0], found[size, 1] = owners[i], owners[j]
            size += 1
    return found[:size].copy()
