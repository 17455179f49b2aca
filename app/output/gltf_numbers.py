"""Positions and normals as glTF stores them: floats, or whole numbers that take less room."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices, Singles

MOST_STEPS = 32_767
"""From the middle of a grid to its ends, in 16 bits."""

MOVED = 0.02
"""Share of a tube's radius by which whole numbers may move its vertices."""

_FLOATING = 2.0**-14
"""Step of encoded floats over the largest of a mesh, at most: about what 16 bits would give."""


Length = TypeVar("Length", float, Floats)


def spacing(radius: Length) -> Length:
    """The widest grid that moves no vertex by more than `MOVED` of ``radius``, one or many.

    Rounding moves by half a step along each of three axes.
    """
    return radius * (2.0 * MOVED / math.sqrt(3.0))


def fits(reach: Length, step: Length) -> Any:
    """Whether coordinates from -``reach`` to ``reach`` are numbered by 16 bits at ``step``.

    One or many; nothing fits a step that is not a number.

    >>> fits(32.767, 0.001), fits(32.769, 0.001)
    (True, False)
    """
    return reach <= (MOST_STEPS + 0.5) * step


def on_grid(positions: Singles, starts: Indices, steps: Floats) -> NDArray[np.int16]:
    """Positions (v, 3) that `fits`, in whole steps; a fourth column is empty, (v, 4).

    ``starts`` (m + 1,) says which are of one mesh, ``steps`` (m,) are the meshes'.
    """
    rows = np.empty((len(positions), 4), dtype=np.int16)
    _count_steps(positions, starts, steps, rows)
    return rows


@njit(cache=True, nogil=True)
def _count_steps(
    positions: Singles, starts: Indices, steps: Floats, rows: NDArray[np.int16]
) -> None:
    for mesh in range(len(starts) - 1):
        each = 1.0 / steps[mesh]
        for row in range(starts[mesh], starts[mesh + 1]):
            for axis in range(3):
                count = np.rint(positions[row, axis] * each)
                rows[row, axis] = np.int16(min(max(count, -MOST_STEPS), MOST_STEPS))
            rows[row, 3] = 0


def rounded(positions: Singles, starts: Indices, step: float) -> tuple[Singles, Any]:
    """Positions (v, 3) with no more digits than matter, and the rows (v, 3) that encode them.

    ``starts`` (m + 1,) says which are of one mesh: they are multiples of one power of two, at most
    ``step`` and `_FLOATING` of the mesh's largest coordinate. Rows are as the filter
    ``EXPONENTIAL`` reads them: an exponent in 8 bits, a signed factor in 24.
    """
    counts = np.diff(starts)
    largest = np.maximum.reduceat(np.abs(positions).max(axis=1), starts[:-1]).astype(np.float64)
    largest = np.maximum(largest, 1e-30)
    wanted = np.floor(np.log2(np.minimum(step, _FLOATING * largest)))
    exponents = np.maximum(wanted, np.ceil(np.log2(largest)) - 22).astype(np.int32)
    each = np.repeat(exponents, counts)[:, None]
    factors = np.rint(np.ldexp(positions.astype(np.float64), -each)).astype(np.int32)
    rows = (each << 24) | (factors & 0xFFFFFF)
    return np.ldexp(factors.astype(np.float32), each).astype(np.float32), rows


def small_normals(normals: Singles) -> NDArray[np.int8]:
    """Unit normals (v, 3) in 127ths, with an empty fourth column, (v, 4)."""
    rows = np.zeros((len(normals), 4), dtype=np.int8)
    rows[:, :3] = np.rint(normals * np.float32(127.0))
    return rows


def folded_normals(normals: Singles) -> NDArray[np.uint8]:
    """Unit normals (v, 3) on an octahedron, 8 bits each way: rows (v, 4) for ``OCTAHEDRAL``."""
    from meshopt import encode_filter_oct

    rows = np.empty((len(normals), 4), dtype=np.float32)
    rows[:, :3], rows[:, 3] = normals, 0.0
    return np.asarray(encode_filter_oct(rows, 4, 8))


def starts_of(counts: Sequence[int]) -> Indices:
    """Where each group of so many begins, and where the last one ends."""
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])


def colors_of(linear: Floats) -> NDArray[np.uint8]:
    """Linear RGB (m, 3) in 255ths, opaque, (m, 4)."""
    rows = np.full((len(linear), 4), 255, dtype=np.uint8)
    rows[:, :3] = np.rint(np.clip(linear, 0.0, 1.0) * 255)
    return rows
