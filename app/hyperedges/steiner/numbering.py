"""Joins and edges in an order that depends only on what is joined to what (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Indices


@njit(cache=True, error_model="numpy")
def number_joins(
    arms: Indices, n: int, order: Indices, parents: Indices, names: Indices, joins: Indices
) -> None:
    """Write the n - 2 joins of a tree into ``joins``, in the order of their numbers.

    A walk from attachment ``names[0]`` takes first, at each join, the branch with the smallest
    name. ``order`` and ``parents`` as `app.hyperedges.steiner.relaxation.walk` writes them;
    ``names`` (n,) of the attachments.
    """
    smallest = np.empty(2 * n - 2, np.int64)
    smallest[:n] = names[:n]
    for place in range(n - 3, -1, -1):
        i = order[place]
        smallest[i] = n
        for side in range(3):
            j = arms[i, side]
            if j != parents[i]:
                smallest[i] = min(smallest[i], smallest[j])
    stack = np.empty(n, np.int64)
    stack[0] = order[0]
    waiting, count = 1, 0
    while waiting > 0:
        waiting -= 1
        i = stack[waiting]
        joins[count] = i
        count += 1
        begin = waiting
        for side in range(3):
            j = arms[i, side]
            if j != parents[i] and j >= n:
                stack[waiting] = j
                waiting += 1
        if waiting == begin + 2 and smallest[stack[begin]] < smallest[stack[begin + 1]]:
            stack[begin], stack[begin + 1] = stack[begin + 1], stack[begin]


@njit(cache=True, error_model="numpy")
def list_edges(
    arms: Indices, n: int, parents: Indices, names: Indices, joins: Indices, edges: Indices
) -> None:
    """Write the 2n - 3 edges: attachments' by name, then those of joins to what they hang from."""
    numbers = np.empty(2 * n - 2, np.int64)
    for k in range(n - 2):
        numbers[joins[k]] = n + k
    for i in range(n):
        edges[names[i], 0], edges[names[i], 1] = names[i], numbers[arms[i, 0]]
    for k in range(1, n - 2):
        edges[n + k - 1, 0], edges[n + k - 1, 1] = numbers[parents[joins[k]]], n + k
