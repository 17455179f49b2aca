"""Smooth noise that repeats: what procedural textures are made of."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.random import Generator

from app.arrays import Indices, Singles


def noise(generator: Generator, size: int, down: int, across: int) -> Singles:
    """Noise (size, size) of mean 0 and variance 1 that goes on over its rims.

    Random numbers on a lattice of ``down`` times ``across`` cells, smoothed by cubic B-splines.
    """
    found = generator.standard_normal((down, across), dtype=np.float32)
    found = _smoothed(_smoothed(found, size).T, size).T
    found -= found.mean()
    found /= found.std()
    return found


def _smoothed(lattice: Singles, size: int) -> Singles:
    """Rows (c, k) of a lattice as ``size`` rows between them, the first after the last."""
    # Sums in this order, and no product of matrices: the same to the bit on any processor.
    total = np.zeros((size, lattice.shape[1]), dtype=np.float32)
    for rows, weights in zip(*_spline(size, len(lattice)), strict=True):
        total += weights[:, None] * lattice[rows]
    return total


@lru_cache(maxsize=64)
def _spline(size: int, cells: int) -> tuple[Indices, Singles]:
    """Cells (4, size) of the uniform cubic B-spline around ``cells`` of them, and weights."""
    places = np.arange(size) * (cells / size)
    first = np.floor(places).astype(np.int64)
    t = places - first
    weights = (
        (1 - t) ** 3 / 6,
        (3 * t**3 - 6 * t**2 + 4) / 6,
        (-3 * t**3 + 3 * t**2 + 3 * t + 1) / 6,
        t**3 / 6,
    )
    found = (first + np.arange(-1, 3)[:, None]) % cells
    return found, np.stack(weights).astype(np.float32)
