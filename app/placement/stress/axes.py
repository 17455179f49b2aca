"""Layouts turned to their principal axes."""

from __future__ import annotations

import math

import numpy as np

from app.arrays import Floats

SWEEPS = 12
"""Of Jacobi's rotations, at most: three axes need some six."""


def turned_to_axes(x: Floats, order: tuple[int, ...]) -> Floats:
    """Points (n, d) about their mean, turned so that they reach farthest along ``order[0]``.

    Then along ``order[1]``, and so on. Along each axis the longer tail is on the positive side.
    """
    centered = x - x.sum(axis=0) / len(x)
    dimensions = x.shape[1]
    moments = [
        [float((centered[:, i] * centered[:, j]).sum()) for j in range(dimensions)]
        for i in range(dimensions)
    ]
    values, vectors = _eigen(moments)
    found = np.zeros_like(x)
    ranks = sorted(range(dimensions), key=lambda axis: (-values[axis], axis))
    for place, rank in zip(order, ranks, strict=True):
        along = sum(vectors[row][rank] * centered[:, row] for row in range(dimensions))
        along = np.asarray(along)
        skew = float((along**3).sum())
        found[:, place] = -along if skew < 0.0 else along
    return found


def _eigen(matrix: list[list[float]]) -> tuple[list[float], list[list[float]]]:
    """Eigenvalues of a small symmetric matrix, and its eigenvectors in columns.

    By Jacobi's rotations, in plain arithmetic: the same on every machine.
    """
    count = len(matrix)
    a = [list(row) for row in matrix]
    vectors = [[float(i == j) for j in range(count)] for i in range(count)]
    for _ in range(SWEEPS):
        for p in range(count):
            for q in range(p + 1, count):
                if abs(a[p][q]) <= 1e-15 * math.sqrt(abs(a[p][p] * a[q][q])):
                    continue
                theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
                t = math.copysign(1.0, theta) / (abs(theta) + math.hypot(theta, 1.0))
                c = 1.0 / math.hypot(t, 1.0)
                s = t * c
                for k in range(count):
                    a[k][p], a[k][q] = c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]
                for k in range(count):
                    a[p][k], a[q][k] = c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]
                for row in vectors:
                    row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
    return [a[k][k] for k in range(count)], vectors
