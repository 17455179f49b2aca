"""How chains of beads bend: drawn straight, but never too tight, nor too short (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices

AT_JOIN = 0.44
"""How far a curve runs beside its beads at a join, over the tube's radius."""

MOST_BESIDE = 1.5
"""The same anywhere, at most."""

TINY = 1e-9
"""Places nearer than this, in document units, have no direction from one to the other."""


@njit(cache=True, error_model="numpy")
def straighten(
    x: Floats,
    links: Indices,
    degrees: Indices,
    stems: Indices,
    thickness: Floats,
    lifts: Floats,
    moving: Indices,
    around: Indices,
    alpha: float,
    beta: float,
    laps: Floats,
    tangents: Floats,
    beside: Floats,
    steps: Floats,
) -> None:
    """Move beads by shares of the Laplacian and the biharmonic operator along their chains.

    A join has one tangent, its stem against the mean of its two other arms; a bead next to it sees
    beyond it its own mirror image along that, not the other arms. Writes ``laps`` (b, 3): from each
    bead to the middle of its neighbours, ``tangents`` (j, 3), and ``beside`` (b,): how far the
    curve runs beside the beads. ``steps`` (b, 3) is room to work in.
    """
    joins = len(stems)
    for i in around:
        degree = degrees[i]
        if degree < 2:
            continue
        square = 0.0
        for axis in range(3):
            total = 0.0
            for k in range(degree):
                total += x[links[i, k], axis]
            laps[i, axis] = total / degree - x[i, axis]
            square += laps[i, axis] * laps[i, axis]
        if i < joins:
            beside[i] = AT_JOIN * thickness[i]
            join_tangent(x, links, stems[i], i, tangents[i])
        else:
            beside[i] = min(np.sqrt(square) / 3.0, MOST_BESIDE * thickness[i])
    for i in moving:
        for axis in range(3):
            steps[i, axis] = alpha * laps[i, axis] + alpha * lifts[i, axis]
        if i < joins:
            continue
        for axis in range(3):
            beyond = 0.0
            for k in range(2):
                j = links[i, k]
                if j >= joins:
                    beyond += laps[j, axis]
                else:
                    sign = 1.0 if links[j, stems[j]] == i else -1.0
                    mirrored = sign * distance(x, i, j) * tangents[j, axis]
                    beyond += 0.5 * (x[i, axis] - x[j, axis] - mirrored)
            steps[i, axis] += beta * (laps[i, axis] - 0.5 * beyond)
    for i in moving:
        for axis in range(3):
            x[i, axis] += steps[i, axis]


@njit(cache=True, error_model="numpy")
def join_tangent(x: Floats, links: Indices, stem: int, i: int, tangent: Floats) -> None:
    """Write the unit tangent (3,) of join ``i``, towards its arm ``stem``, 0 to 2."""
    square = 0.0
    tangent[:] = 0.0
    for k in range(3):
        j = links[i, k]
        share = (1.0 if k == stem else -0.5) / max(distance(x, i, j), TINY)
        for axis in range(3):
            tangent[axis] += share * (x[j, axis] - x[i, axis])
    for axis in range(3):
        square += tangent[axis] * tangent[axis]
    length = np.sqrt(square)
    if length < TINY:
        tangent[0], length = 1.0, 1.0
    for axis in range(3):
        tangent[axis] /= length


@njit(cache=True, error_model="numpy")
def unbend(
    x: Floats,
    links: Indices,
    degrees: Indices,
    bends: Floats,
    free: Floats,
    around: Indices,
    sums: Floats,
    weights: Floats,
) -> None:
    """Add what opens chains where radii of curvature are below ``bends`` (b,).

    At a bead a spline has the velocity d, half of the way between the neighbours, and the
    acceleration s, their second difference, so that its radius of curvature is |d|^2 / |s| or more.
    """
    for i in around:
        if degrees[i] != 2:
            continue
        p, q = links[i, 0], links[i, 1]
        velocity = acceleration = 0.0
        for axis in range(3):
            velocity += (0.5 * (x[q, axis] - x[p, axis])) ** 2
            acceleration += (x[q, axis] + x[p, axis] - 2.0 * x[i, axis]) ** 2
        acceleration = np.sqrt(acceleration)
        allowed = velocity / bends[i]
        total = 4.0 * free[i] + free[p] + free[q]
        if acceleration <= allowed or total == 0.0:
            continue
        share = (acceleration - allowed) / (acceleration * total)
        for axis in range(3):
            way = share * (x[q, axis] + x[p, axis] - 2.0 * x[i, axis])
            sums[i, axis] += 2.0 * free[i] * way
            sums[p, axis] -= free[p] * way
            sums[q, axis] -= free[q] * way
        weights[i] += free[i]
        weights[p] += 0.5 * free[p]
        weights[q] += 0.5 * free[q]


@njit(cache=True, error_model="numpy")
def keep_long(
    x: Floats,
    links: Indices,
    degrees: Indices,
    spans: Floats,
    free: Floats,
    around: Indices,
    sums: Floats,
    weights: Floats,
) -> None:
    """Add what keeps beads of two links at least ``spans`` (b,) from these.

    Else bends would shrink to where beads lie on each other.
    """
    for i in around:
        if degrees[i] != 2:
            continue
        for k in range(2):
            j = links[i, k]
            length, shares = distance(x, i, j), free[i] + free[j]
            if length >= spans[i] or length < TINY or shares == 0.0:
                continue
            push = 0.5 * (spans[i] - length) / (length * shares)
            for axis in range(3):
                way = push * (x[i, axis] - x[j, axis])
                sums[i, axis] += free[i] * way
                sums[j, axis] -= free[j] * way
            weights[i] += 0.5 * free[i]
            weights[j] += 0.5 * free[j]


@njit(cache=True, error_model="numpy", inline="always")
def distance(x: Floats, i: int, j: int) -> float:
    """How far two beads are apart."""
    a, b, c = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1], x[i, 2] - x[j, 2]
    return float(np.sqrt(a * a + b * b + c * c))
