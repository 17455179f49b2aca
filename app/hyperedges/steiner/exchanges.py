"""Shorter trees of the same attachments, by small changes (Numba).

Two neighbouring joins exchange a branch each; a branch moves to another edge nearby. A change is
made where it shortens the tree, with the joins around it in their new places. What is far from the
last round's changes is not tried again.

A tree is ``at`` and ``arms``, as `app.hyperedges.steiner.relaxation` has them.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.growth import SETTLING, best_edge, edges_near, settle, turn_arm
from app.hyperedges.steiner.meeting import distance, meet

GAIN = 1e-6
"""A change has to shorten what is around it by this share, or rounding could keep it going."""

ROUNDS = 20
"""So many rounds are made at most; 3 to 8 are usual."""

REACH = 32
"""How many edges are tried for a branch."""

SETTLED = 8
"""How often the joins around an exchange are moved."""

HOPELESS = 1.05
"""An exchange that is longer by this factor after two moves never became shorter."""


@njit(cache=True, error_model="numpy")
def improve(at: Floats, arms: Indices, n: int) -> None:
    """Change a tree of n >= 4 attachments until no small change makes it shorter."""
    touched = np.zeros(2 * n - 2, np.int64)
    for now in range(ROUNDS):
        changes = _exchange_branches(at, arms, n, touched, now)
        changes += _move_branches(at, arms, n, touched, now)
        if changes == 0:
            break


@njit(cache=True, error_model="numpy")
def _exchange_branches(at: Floats, arms: Indices, n: int, touched: Indices, now: int) -> int:
    """Try to exchange branches across every edge between joins; the number of exchanges.

    ``touched`` (2n - 2,) says in which round there was a change near a node last, plus one.
    """
    branches = np.empty(4, np.int64)
    kept = np.empty((6, 3))
    changes = 0
    for a in range(n, 2 * n - 2):
        for side in range(3):
            b = arms[a, side]
            if b <= a or (touched[a] < now and touched[b] < now):
                continue
            _find_branches(arms, a, b, branches)
            if _exchange(at, arms, n, a, b, branches, kept):
                changes += 1
                touched[a] = touched[b] = now + 1
                for i in branches:
                    touched[i] = now + 1
    return changes


@njit(cache=True, error_model="numpy")
def _find_branches(arms: Indices, a: int, b: int, branches: Indices) -> None:
    """Write the other two arms of neighbours a and b."""
    count = 0
    for side in range(6):
        i = arms[a if side < 3 else b, side % 3]
        if i not in (a, b):
            branches[count] = i
            count += 1


@njit(cache=True, error_model="numpy")
def _exchange(
    at: Floats, arms: Indices, n: int, a: int, b: int, branches: Indices, kept: Floats
) -> bool:
    """Exchange a's second branch with one of b's if that makes the tree shorter; whether it did."""
    least = _length_around(at, arms, a, b, branches) * (1.0 - GAIN)
    for axis in range(3):
        kept[4, axis], kept[5, axis] = at[a, axis], at[b, axis]
        for k in range(4):
            kept[k, axis] = at[branches[k], axis]
    for choice in range(2):
        given, taken, left = branches[1], branches[2 + choice], branches[3 - choice]
        _swap(arms, a, b, given, taken)
        # From apart, because joins that begin in one place may never part.
        for axis in range(3):
            at[a, axis] = 0.5 * (at[branches[0], axis] + at[taken, axis])
            at[b, axis] = 0.5 * (at[given, axis] + at[left, axis])
        for move in range(SETTLED):
            meet(at, arms[a, 0], arms[a, 1], arms[a, 2], a)
            meet(at, arms[b, 0], arms[b, 1], arms[b, 2], b)
            for i in branches:
                if i >= n:
                    meet(at, arms[i, 0], arms[i, 1], arms[i, 2], i)
            if move == 1 and _length_around(at, arms, a, b, branches) > HOPELESS * least:
                break
        if _length_around(at, arms, a, b, branches) < least:
            return True
        _swap(arms, a, b, taken, given)
        for axis in range(3):
            at[a, axis], at[b, axis] = kept[4, axis], kept[5, axis]
            for k in range(4):
                at[branches[k], axis] = kept[k, axis]
    return False


@njit(cache=True, error_model="numpy")
def _swap(arms: Indices, a: int, b: int, given: int, taken: int) -> None:
    """Node ``given`` moves from a to b, ``taken`` from b to a."""
    turn_arm(arms, a, given, taken)
    turn_arm(arms, b, taken, given)
    turn_arm(arms, given, a, b)
    turn_arm(arms, taken, b, a)


@njit(cache=True, error_model="numpy")
def _length_around(at: Floats, arms: Indices, a: int, b: int, branches: Indices) -> float:
    """The length of the edges at neighbours a and b and at what they are joined to."""
    total = distance(at, a, b)
    for i in branches:
        for side in range(3):
            if arms[i, side] >= 0:
                total += distance(at, i, arms[i, side])
    return total


@njit(cache=True, error_model="numpy")
def _move_branches(at: Floats, arms: Indices, n: int, touched: Indices, now: int) -> int:
    """Try to move every branch, with its join, to another edge; the number of moves."""
    found = np.empty((REACH, 2), np.int64)
    changes = 0
    for i in range(2 * n - 2):
        for side in range(3):
            join = arms[i, side]
            if join < n or (touched[join] < now and touched[i] < now):
                continue
            if _move(at, arms, n, i, join, found, touched, now):
                changes += 1
    return changes


@njit(cache=True, error_model="numpy")
def _move(
    at: Floats,
    arms: Indices,
    n: int,
    i: int,
    join: int,
    found: Indices,
    touched: Indices,
    now: int,
) -> bool:
    """Move a join with the branch that begins at node i if that pays; whether it did."""
    a, b = arms[join, 0], arms[join, 1]
    if a == i:
        a = arms[join, 2]
    elif b == i:
        b = arms[join, 2]
    turn_arm(arms, a, join, b)
    turn_arm(arms, b, join, a)
    saved = distance(at, a, join) + distance(at, b, join) + distance(at, i, join)
    saved -= distance(at, a, b)
    count = edges_near(arms, a, found)
    c, d, cost = best_edge(at, i, found, count)
    if not cost < saved * (1.0 - GAIN):
        turn_arm(arms, a, b, join)
        turn_arm(arms, b, a, join)
        return False
    turn_arm(arms, c, d, join)
    turn_arm(arms, d, c, join)
    arms[join, 0], arms[join, 1], arms[join, 2] = i, c, d
    settle(at, arms, n, join, found[:SETTLING], 3)
    settle(at, arms, n, a, found[:SETTLING], 3)
    for node in (a, b, c, d, i, join):
        touched[node] = now + 1
    return True
