"""One step of Newton's method for the joins of a tree (Numba).

Along each edge there is a force f, of strength one or less, that should become x / √(x² + ε²), with
x the edge as a vector. Newton's method for places and forces together converges in few steps even
where edges vanish, which it does not for places alone (Andersen, Christiansen, Conn and Overton
2000; Chan, Golub and Mulet 1999).

As joins form a tree, their equations are solved in time proportional to their number, by
eliminating joins from the outermost inwards. A tree is ``at``, ``arms``, ``order`` and ``parents``,
as `app.hyperedges.steiner.relaxation` has them.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.symmetric import add, inverse, read, sandwich, times, write


class System(NamedTuple):
    """Newton's equations for the m joins of a tree of n attachments.

    Of joins: ``matrices`` (m, 6), ``slopes`` (m, 3), ``couplings`` (m, 6) with the join that each
    hangs from, and the solution ``steps`` (m, 3). Of nodes: ``forces`` (n + m, 3) along the edge to
    what each hangs from.
    """

    matrices: Floats
    slopes: Floats
    couplings: Floats
    steps: Floats
    forces: Floats


@njit(cache=True, error_model="numpy")
def empty_system(n: int) -> System:
    """Equations for a tree of n attachments, without forces."""
    m = n - 2
    return System(
        np.empty((m, 6)), np.empty((m, 3)), np.empty((m, 6)), np.empty((m, 3)), np.zeros((n + m, 3))
    )


@njit(cache=True, error_model="numpy")
def set_up(
    system: System,
    at: Floats,
    arms: Indices,
    n: int,
    order: Indices,
    parents: Indices,
    smoothing: float,
) -> None:
    """Write matrices, slopes and couplings; ``smoothing`` is ε."""
    matrices, slopes, couplings, _, forces = system
    matrices[:] = 0.0
    slopes[:] = 0.0
    for k in range(n - 2):
        join = order[k]
        for side in range(3):
            # Each edge once: those to what hangs from the join, and that of attachment 0.
            i, up = arms[join, side], join
            if i == parents[join]:
                if i >= n:
                    continue
                i, up = join, i
            x, y, z = at[i, 0] - at[up, 0], at[i, 1] - at[up, 1], at[i, 2] - at[up, 2]
            r = 1.0 / sqrt(x * x + y * y + z * z + smoothing * smoothing)
            x, y, z = x * r, y * r, z * r
            f, g, h = forces[i, 0], forces[i, 1], forces[i, 2]
            matrix = (
                r * (1.0 - f * x),
                r * (1.0 - g * y),
                r * (1.0 - h * z),
                -0.5 * r * (f * y + g * x),
                -0.5 * r * (f * z + h * x),
                -0.5 * r * (g * z + h * y),
            )
            if up >= n:
                _enter(matrices, slopes, up - n, matrix, -x, -y, -z)
            if i >= n:
                _enter(matrices, slopes, i - n, matrix, x, y, z)
                write(couplings, i - n, matrix)


@njit(cache=True, error_model="numpy")
def _enter(
    matrices: Floats,
    slopes: Floats,
    row: int,
    matrix: tuple[float, float, float, float, float, float],
    x: float,
    y: float,
    z: float,
) -> None:
    add(matrices, row, matrix, 1.0)
    slopes[row, 0] += x
    slopes[row, 1] += y
    slopes[row, 2] += z


@njit(cache=True, error_model="numpy")
def solve(system: System, n: int, order: Indices, parents: Indices) -> float:
    """Write the steps, and return twice what they should gain."""
    matrices, slopes, couplings, steps, _ = system
    gain = 0.0
    for k in range(n - 3, -1, -1):
        row = order[k] - n
        up = parents[order[k]] - n
        matrix = inverse(read(matrices, row))
        write(matrices, row, matrix)
        a, b, c = slopes[row, 0], slopes[row, 1], slopes[row, 2]
        x, y, z = times(matrix, a, b, c)
        gain += a * x + b * y + c * z
        if up >= 0:
            coupling = read(couplings, row)
            add(matrices, up, sandwich(coupling, matrix), -1.0)
            x, y, z = times(coupling, x, y, z)
            slopes[up, 0] += x
            slopes[up, 1] += y
            slopes[up, 2] += z
    for k in range(n - 2):
        row = order[k] - n
        up = parents[order[k]] - n
        a, b, c = -slopes[row, 0], -slopes[row, 1], -slopes[row, 2]
        if up >= 0:
            x, y, z = times(read(couplings, row), steps[up, 0], steps[up, 1], steps[up, 2])
            a, b, c = a + x, b + y, c + z
        steps[row, 0], steps[row, 1], steps[row, 2] = times(read(matrices, row), a, b, c)
    return gain


@njit(cache=True, error_model="numpy")
def pull(system: System, at: Floats, n: int, parents: Indices, smoothing: float) -> None:
    """Change the forces as the steps, which are not taken yet, demand.

    Those that become stronger than one are made so strong.
    """
    steps, forces = system.steps, system.forces
    edge, change = np.empty(3), np.empty(3)
    for i in range(1, 2 * n - 2):
        up = parents[i]
        square = smoothing * smoothing
        along = 0.0
        for axis in range(3):
            edge[axis] = at[i, axis] - at[up, axis]
            change[axis] = 0.0
            if i >= n:
                change[axis] += steps[i - n, axis]
            if up >= n:
                change[axis] -= steps[up - n, axis]
            square += edge[axis] * edge[axis]
            along += edge[axis] * change[axis]
        r = 1.0 / sqrt(square)
        along *= r
        strength = 0.0
        for axis in range(3):
            forces[i, axis] = r * (edge[axis] + change[axis] - forces[i, axis] * along)
            strength += forces[i, axis] * forces[i, axis]
        if strength > 1.0:
            strength = sqrt(strength)
            for axis in range(3):
                forces[i, axis] /= strength
