"""Symmetric 3×3 matrices as six numbers: xx, yy, zz, xy, xz, yz (Numba)."""

from __future__ import annotations

from typing import TypeAlias

from numba import njit

from app.arrays import Floats

Symmetric: TypeAlias = tuple[float, float, float, float, float, float]
Vector: TypeAlias = tuple[float, float, float]


@njit(cache=True, error_model="numpy")
def read(rows: Floats, i: int) -> Symmetric:
    """The matrix in row i of an array (n, 6)."""
    return rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3], rows[i, 4], rows[i, 5]


@njit(cache=True, error_model="numpy")
def write(rows: Floats, i: int, matrix: Symmetric) -> None:
    """Put the matrix in row i of an array (n, 6)."""
    rows[i, 0], rows[i, 1], rows[i, 2] = matrix[0], matrix[1], matrix[2]
    rows[i, 3], rows[i, 4], rows[i, 5] = matrix[3], matrix[4], matrix[5]


@njit(cache=True, error_model="numpy")
def add(rows: Floats, i: int, matrix: Symmetric, factor: float) -> None:
    """Add a multiple of the matrix to row i of an array (n, 6)."""
    rows[i, 0] += factor * matrix[0]
    rows[i, 1] += factor * matrix[1]
    rows[i, 2] += factor * matrix[2]
    rows[i, 3] += factor * matrix[3]
    rows[i, 4] += factor * matrix[4]
    rows[i, 5] += factor * matrix[5]


@njit(cache=True, error_model="numpy")
def times(matrix: Symmetric, x: float, y: float, z: float) -> Vector:
    """The product with a vector."""
    xx, yy, zz, xy, xz, yz = matrix
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@njit(cache=True, error_model="numpy")
def inverse(matrix: Symmetric) -> Symmetric:
    """The inverse of a positive definite matrix, through its factors L·D·Lᵀ.

    A pivot that rounding made too small counts as one that is just large enough.
    """
    xx, yy, zz, xy, xz, yz = matrix
    least = 1e-14 * (xx + yy + zz) + 1e-300
    first = max(xx, least)
    a, b = xy / first, xz / first
    second = max(yy - a * xy, least)
    c = (yz - a * xz) / second
    third = max(zz - b * xz - c * c * second, least)
    d = a * c - b
    p, q, r = 1.0 / first, 1.0 / second, 1.0 / third
    return (
        p + a * a * q + d * d * r,
        q + c * c * r,
        r,
        -a * q - d * c * r,
        d * r,
        -c * r,
    )


@njit(cache=True, error_model="numpy")
def sandwich(outer: Symmetric, inner: Symmetric) -> Symmetric:
    """The product outer · inner · outer."""
    xx, yy, zz, xy, xz, yz = outer
    x0, x1, x2 = times(inner, xx, xy, xz)
    y0, y1, y2 = times(inner, xy, yy, yz)
    z0, z1, z2 = times(inner, xz, yz, zz)
    return (
        xx * x0 + xy * x1 + xz * x2,
        xy * y0 + yy * y1 + yz * y2,
        xz * z0 + yz * z1 + zz * z2,
        xx * y0 + xy * y1 + xz * y2,
        xx * z0 + xy * z1 + xz * z2,
        xy * z0 + yy * z1 + yz * z2,
    )
