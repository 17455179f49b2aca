"""Rectangles packed on shelves, large ones first."""

from __future__ import annotations

import math

import numpy as np

from app.arrays import Floats

ASPECT = 1.3
"""Width over height that the whole aims at."""


def shelved(sizes: Floats, gap: float) -> Floats:
    """Middles (k, 2) of rectangles of ``sizes`` (k, 2) on shelves, from the top down.

    They are ``gap`` apart; the top left corner of all is at (0, 0).
    """
    areas = sizes[:, 0] * sizes[:, 1]
    order = np.lexsort((np.arange(len(sizes)), -sizes[:, 0], -areas))
    wanted = math.sqrt(ASPECT * float(((sizes[:, 0] + gap) * (sizes[:, 1] + gap)).sum()))
    widest = max(float(sizes[:, 0].max()), wanted)
    middles = np.empty((len(sizes), 2))
    left = top = shelf = 0.0
    for number in order.tolist():
        width, height = sizes[number].tolist()
        if left > 0.0 and left + width > widest:
            left, top, shelf = 0.0, top - shelf - gap, 0.0
        middles[number] = left + width / 2, top - height / 2
        left += width + gap
        shelf = max(shelf, height)
    return middles
