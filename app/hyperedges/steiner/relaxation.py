"""The best places for the joins of a given tree (Numba).

The length of a tree is a convex function of where its joins are, with kinks where an edge vanishes.
The sum of √(l² + ε²) rounds the kinks off and is never more than ε an edge too long; its minimum is
found for smaller and smaller ε.

A tree is ``at`` (2n - 2, 3), its n attachments then its joins, and ``arms`` (2n - 2, 3): what each
is joined to; attachments have one arm, then -1.
"""

from __future__ import annotations

from math import sqrt

from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.meeting import meet
from app.hyperedges.steiner.newton import System, empty_system, pull, set_up, solve

COARSE, FINE = 1e-1, 1e-4
"""Newton's method stops when the next step gains less than this share of ε for each join."""

STEPS = 60
"""So many of Newton's steps are taken at most; 10 to 30 are usual."""


@njit(cache=True, error_model="numpy")
def tree_length(at: Floats, arms: Indices, n: int, smoothing: float) -> float:
    """The sum of √(l² + ``smoothing``²) of the edges of a tree of n attachments, 3 or more."""
    total = 0.0
    for i in range(n, 2 * n - 2):
        for side in range(3):
            j = arms[i, side]
            if j < i:
                square = smoothing * smoothing
                for axis in range(3):
                    square += (at[i, axis] - at[j, axis]) ** 2
                total += sqrt(square)
    return total


@njit(cache=True, error_model="numpy")
def walk(arms: Indices, n: int, order: Indices, parents: Indices) -> None:
    """Write the n - 2 joins, parents first, and what each node hangs from.

    Attachment 0 is the root.
    """
    parents[0] = -1
    order[0] = arms[0, 0]
    parents[order[0]] = 0
    count = 1
    for place in range(n - 2):
        i = order[place]
        for side in range(3):
            j = arms[i, side]
            if j != parents[i]:
                parents[j] = i
                if j >= n:
                    order[count] = j
                    count += 1


@njit(cache=True, error_model="numpy")
def relax(
    at: Floats,
    arms: Indices,
    n: int,
    order: Indices,
    parents: Indices,
    first: float,
    last: float,
    precision: float,
) -> None:
    """Move the joins to where the tree is shortest; ε goes from ``first`` to ``last``.

    ``order`` and ``parents`` as `walk` writes them. The tree never gets longer.
    """
    before = at[n : 2 * n - 2].copy()
    length = tree_length(at, arms, n, 0.0)
    system = empty_system(n)
    smoothing = first
    for _ in range(STEPS):
        set_up(system, at, arms, n, order, parents, smoothing)
        gain = solve(system, n, order, parents)
        pull(system, at, n, parents, smoothing)
        moved = _move(system, at, arms, n, smoothing, gain)
        gain /= n - 2
        if smoothing > last and gain < COARSE * smoothing:
            smoothing = max(min(0.01 * smoothing, gain), last)
        elif not moved or gain < precision * smoothing:
            break
    if tree_length(at, arms, n, 0.0) > length:
        at[n : 2 * n - 2] = before


@njit(cache=True, error_model="numpy")
def snap(at: Floats, arms: Indices, n: int) -> None:
    """Put relaxed joins that are all but on an attachment or another join exactly there.

    That is where their arms meet, if the joins at their ends stay.
    """
    for i in range(n, 2 * n - 2):
        meet(at, arms[i, 0], arms[i, 1], arms[i, 2], i)


@njit(cache=True, error_model="numpy")
def _move(system: System, at: Floats, arms: Indices, n: int, smoothing: float, gain: float) -> bool:
    """Take the step, or half of it, and so on, until the tree gets shorter; whether it did."""
    # Rounding hides what is less than this.
    most = tree_length(at, arms, n, smoothing) * (1.0 + 1e-15)
    share, taken = 1.0, 0.0
    for _ in range(20):
        for i in range(n - 2):
            for axis in range(3):
                at[n + i, axis] += (share - taken) * system.steps[i, axis]
        if tree_length(at, arms, n, smoothing) <= most - 0.1 * share * gain:
            return True
        taken = share
        share *= 0.5
    for i in range(n - 2):
        for axis in range(3):
            at[n + i, axis] -= taken * system.steps[i, axis]
    return False
