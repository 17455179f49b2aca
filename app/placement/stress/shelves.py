"""Rectangles packed on shelves, large ones first."""

from __future__ import annotations

import math

import numpy as np

from app.arrays import Floats, Indices

ASPECT = 1.3
"""Width over height that the whole aims at."""


def shelved(sizes: Floats, gap: float) -> Floats:
    """Middles (k, 2) of rectangles of ``sizes`` (k, 2) on shelves, from the top down.

    They are ``gap`` apart; the top left corner of all is at (0, 0). Shelves are as long as makes
    the smaller and better proportioned whole of two: as the largest, or as a whole of good
    proportions.
    """
    areas = sizes[:, 0] * sizes[:, 1]
    order = np.lexsort((np.arange(len(sizes)), -sizes[:, 0], -areas))
    wanted = math.sqrt(ASPECT * float(((sizes[:, 0] + gap) * (sizes[:, 1] + gap)).sum()))
    widest = float(sizes[:, 0].max())
    tries = [_on_shelves(sizes, order, gap, max(widest, length)) for length in (widest, wanted)]
    costs = []
    for middles in tries:
        width, height = (middles + sizes / 2).max(axis=0) - (middles - sizes / 2).min(axis=0)
        aspect = max(width, 1e-9) / max(height, 1e-9)
        costs.append(width * height * max(aspect / ASPECT, ASPECT / aspect))
    return tries[0 if costs[0] <= costs[1] else 1]


def _on_shelves(sizes: Floats, order: Indices, gap: float, length: float) -> Floats:
    middles = np.empty((len(sizes), 2))
    left = top = shelf = 0.0
    for number in order.tolist():
        width, height = sizes[number].tolist()
        if left > 0.0 and left + width > length:
            left, top, shelf = 0.0, top - shelf - gap, 0.0
        middles[number] = left + width / 2, top - height / 2
        left += width + gap
        shelf = max(shelf, height)
    return middles
