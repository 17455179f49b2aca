"""Granite: grains of a few minerals, side by side."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices, Singles
from app.scene.noise import noise

CELLS = 72
"""Grains down and across one texture."""

# Feldspar, light and darker quartz, mica: linear RGB that multiplies the stone's colour.
_MINERALS = np.array(
    [[1.0, 0.985, 0.96], [0.80, 0.79, 0.79], [0.56, 0.555, 0.56], [0.10, 0.10, 0.11]]
)
_SHARES = (0.46, 0.30, 0.16, 0.08)


def stone(size: int) -> Singles:
    """Linear RGB (size, size, 3), not normalised; alike in all directions."""
    generator = np.random.default_rng(1912)
    minerals = generator.choice(len(_MINERALS), CELLS * CELLS, p=_SHARES)
    shades = _MINERALS[minerals] * generator.normal(1.0, 0.07, (CELLS * CELLS, 1))
    fine = noise(generator, size, size // 3, size // 3)
    light = 1.0 + 0.04 * fine + 0.025 * noise(generator, size, 8, 8)
    color = shades.astype(np.float32)[_grains(generator, size)] * light[..., None]
    return np.asarray(np.clip(color, 0.02, None), dtype=np.float32)


def _grains(generator: np.random.Generator, size: int) -> Indices:
    """The number (size, size) of the grain at each place: the nearest one, in a shaken plane.

    One grain is anywhere in each cell of a grid (Worley 1996, "A cellular texture basis function").
    """
    middles = generator.random((2, CELLS, CELLS), dtype=np.float32)
    ticks = np.arange(size, dtype=np.float32) * (CELLS / size)
    # Shaken, so that grains are ragged.
    down, across = (
        ticks.reshape(shape)
        + 0.25 * noise(generator, size, size // 8, size // 8)
        + 0.115 * noise(generator, size, size // 3, size // 3)
        for shape in ((-1, 1), (1, -1))
    )
    row, column = np.floor(down), np.floor(across)
    down, across = down - row, across - column
    rows, columns = row.astype(np.int32), column.astype(np.int32)
    nearest = np.full((size, size), np.inf, dtype=np.float32)
    found = np.zeros((size, size), dtype=np.int64)
    for below in (-1, 0, 1):
        for beside in (-1, 0, 1):
            cells = (rows + below) % CELLS * CELLS + (columns + beside) % CELLS
            distance = (middles[0].ravel()[cells] + (below - down)) ** 2
            distance += (middles[1].ravel()[cells] + (beside - across)) ** 2
            is_nearer = distance < nearest
            np.copyto(nearest, distance, where=is_nearer)
            np.copyto(found, cells, where=is_nearer)
    return found
