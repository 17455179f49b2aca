"""A first tree: attachments are added one by one, each by a join on an edge nearby (Numba).

A tree is ``at`` and ``arms``, as `app.hyperedges.steiner.relaxation` has them. An attachment could
always be joined to its neighbour in the minimum spanning tree, at the cost of that edge, so the
tree is never longer than the minimum spanning tree.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.steiner.meeting import distance, meet, meeting_length

REACH = 64
"""How many edges are tried for each attachment."""

SETTLING = 12
"""How many edges around a new join settle at once."""


@njit(cache=True, error_model="numpy")
def turn_arm(arms: Indices, i: int, old: int, new: int) -> None:
    """Join a node to ``new`` instead of ``old``."""
    for side in range(3):
        if arms[i, side] == old:
            arms[i, side] = new
            return


@njit(cache=True, error_model="numpy")
def put_on_edge(arms: Indices, join: int, a: int, b: int, i: int) -> None:
    """Put a join on the edge from a to b and hang node i from it by its first arm."""
    turn_arm(arms, a, b, join)
    turn_arm(arms, b, a, join)
    arms[join, 0], arms[join, 1], arms[join, 2] = i, a, b
    arms[i, 0] = join


@njit(cache=True, error_model="numpy")
def edges_near(arms: Indices, start: int, found: Indices) -> int:
    """Write up to len(found) edges nearest to a node, by steps, and return how many.

    Each is a row: its farther end, and the end through which it was reached.
    """
    count = 0
    done = -1
    while count < len(found) and done < count:
        i, origin = (start, -1) if done < 0 else (found[done, 0], found[done, 1])
        done += 1
        for side in range(3):
            j = arms[i, side]
            if j >= 0 and j != origin and count < len(found):
                found[count, 0], found[count, 1] = j, i
                count += 1
    return count


@njit(cache=True, error_model="numpy")
def settle(at: Floats, arms: Indices, n: int, join: int, found: Indices, rounds: int) -> None:
    """Move a join and those around it to where their arms meet, in turn."""
    count = edges_near(arms, join, found)
    for _ in range(rounds):
        if join >= n:
            meet(at, arms[join, 0], arms[join, 1], arms[join, 2], join)
        for k in range(count):
            i = found[k, 0]
            if i >= n:
                meet(at, arms[i, 0], arms[i, 1], arms[i, 2], i)


@njit(cache=True, error_model="numpy")
def best_edge(at: Floats, i: int, found: Indices, count: int) -> tuple[int, int, float]:
    """Of ``count`` edges that on which a join costs least to hang node i from, and the cost."""
    best = np.inf
    a = b = -1
    for k in range(count):
        first, second = found[k, 1], found[k, 0]
        cost = meeting_length(at, first, second, i) - distance(at, first, second)
        if cost < best:
            best = cost
            a, b = first, second
    return a, b, best


@njit(cache=True, error_model="numpy")
def grow(at: Floats, arms: Indices, n: int, parents: Indices) -> None:
    """Make a tree of n >= 2 attachments, each of which has a parent that comes before it."""
    arms[: 2 * n - 2] = -1
    arms[0, 0], arms[1, 0] = 1, 0
    found = np.empty((REACH, 2), np.int64)
    for i in range(2, n):
        join = n + i - 2
        count = edges_near(arms, parents[i], found)
        a, b, _ = best_edge(at, i, found, count)
        put_on_edge(arms, join, a, b, i)
        settle(at, arms, n, join, found[:SETTLING], 3)
