"""The circle that is swept: how many sides it has, and where they are."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from app.arrays import Floats, Indices, Singles

FEWEST_SIDES = 4
"""Of tubes so far away that they are hardly more than a line."""

MOST_SIDES = 128
"""No picture shows more, whatever the tolerance asks for."""


def sides_of(radii: Floats, tolerance: float | Floats) -> Indices:
    """Sides of the tubes of h hyperedges, (h,), so that no chord is off by more than ``tolerance``.

    One tolerance for all, or one for each (h,). Even, so that a patch pair has as many on its top
    as on its bottom; at least `FEWEST_SIDES`, at most `MOST_SIDES`. Raises ValueError where a
    tolerance is not positive.

    >>> sides_of(np.array([1.0, 2.0, 1e9]), 0.02).tolist()
    [16, 24, 128]
    """
    if not np.all(np.greater(tolerance, 0.0)):
        raise ValueError(f"A tolerance must be positive, not {np.min(tolerance)!r}.")
    half_angles = np.arccos(np.maximum(1.0 - tolerance / np.maximum(radii, tolerance), 0.0))
    wanted = np.pi / np.maximum(half_angles, np.pi / MOST_SIDES)
    sides = np.maximum(2 * np.ceil(0.5 * wanted - 1e-9), FEWEST_SIDES)
    return np.asarray(sides, dtype=np.int64)


def tolerances_of(radii: Floats, tolerance: float | Floats) -> Floats:
    """What ``tolerance``, one or (h,), comes to for each of h radii, (h,).

    `MOST_SIDES` are the finest there are.
    """
    return np.asarray(np.maximum(tolerance, radii * (1.0 - np.cos(np.pi / MOST_SIDES))))


def cap_rings(sides: Indices) -> Indices:
    """Rings of a rounded end between its pole and the tube's last ring, as far apart as sides."""
    return -(-sides // 4) - 1


@lru_cache(maxsize=1)
def circles() -> Singles:
    """Cosines and sines of every number of sides, twice around: [sides, 0 or 1, side].

    Mirror images agree to the bit, so that a circle that is run through backwards has the same
    vertices.
    """
    table = np.zeros((MOST_SIDES + 1, 2, 2 * MOST_SIDES), dtype=np.float32)
    for sides in range(FEWEST_SIDES, MOST_SIDES + 1, 2):
        angles = np.arange(sides // 4 + 1) * (2.0 * np.pi / sides)
        cosines, sines = np.cos(angles), np.sin(angles)
        if sides % 4 == 0:
            cosines[-1] = 0.0
        # From a quarter to a half, and on to the whole.
        mirrored = slice(None, None, -1) if sides % 4 else slice(-2, None, -1)
        cosines = np.concatenate([cosines, -cosines[mirrored]])[: sides // 2]
        sines = np.concatenate([sines, sines[mirrored]])[: sides // 2]
        around = [np.concatenate([cosines, -cosines]), np.concatenate([sines, -sines])]
        table[sides, :, : 2 * sides] = np.tile(around, 2)
    table.setflags(write=False)
    return table


@lru_cache(maxsize=1)
def latitudes() -> Floats:
    """Cosines and sines of the rings of a rounded end, from its pole on: [sides, 0 or 1, ring]."""
    table = np.zeros((MOST_SIDES + 1, 2, MOST_SIDES // 4))
    for sides in range(FEWEST_SIDES, MOST_SIDES + 1, 2):
        steps = -(-sides // 4)
        angles = (0.5 * np.pi) * (1.0 - np.arange(1, steps) / steps)
        table[sides, 0, : steps - 1], table[sides, 1, : steps - 1] = np.cos(angles), np.sin(angles)
    table.setflags(write=False)
    return table
