"""Polylines, and places evenly along them (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices


class Polylines(NamedTuple):
    """A polyline for each chain: ``points`` (p, 3), chain k's from ``starts[k]`` (c + 1,)."""

    points: Floats
    starts: Indices


def lengths_of(lines: Polylines) -> Floats:
    """The lengths of polylines, (c,)."""
    steps = np.linalg.norm(np.diff(lines.points, axis=0), axis=1)
    walked = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(walked[lines.starts[1:] - 1] - walked[lines.starts[:-1]])


@njit(cache=True, error_model="numpy")
def resample(points: Floats, starts: Indices, counts: Indices, firsts: Indices, x: Floats) -> None:
    """Write beads evenly along polylines, without their ends."""
    for chain in range(len(counts)):
        begin, end = starts[chain], starts[chain + 1]
        total = 0.0
        for i in range(begin, end - 1):
            total += _distance(points, i)
        i, before = begin, 0.0
        step = _distance(points, i)
        for k in range(1, counts[chain]):
            wanted = total * k / counts[chain]
            while before + step < wanted and i < end - 2:
                before += step
                i += 1
                step = _distance(points, i)
            share = (wanted - before) / step if step > 0.0 else 0.0
            for axis in range(3):
                x[firsts[chain] + k - 1, axis] = points[i, axis] + share * (
                    points[i + 1, axis] - points[i, axis]
                )


@njit(cache=True, error_model="numpy")
def _distance(points: Floats, i: int) -> float:
    a = points[i + 1, 0] - points[i, 0]
    b = points[i + 1, 1] - points[i, 1]
    c = points[i + 1, 2] - points[i, 2]
    return float(np.sqrt(a * a + b * b + c * c))
