"""Pieces of curves waiting to be looked at, the nearest first (Numba).

A binary heap of row numbers, ordered by a number of each row; of equal ones any may come first, but
always the same one.
"""

from __future__ import annotations

from numba import njit

from app.arrays import Floats, Indices


@njit(cache=True, error_model="numpy")
def push(heap: Indices, count: int, keys: Floats, row: int) -> None:
    """Put ``row`` among the ``count`` rows that are in the heap."""
    place = count
    key = keys[row]
    while place > 0:
        parent = (place - 1) >> 1
        if keys[heap[parent]] <= key:
            break
        heap[place] = heap[parent]
        place = parent
    heap[place] = row


@njit(cache=True, error_model="numpy")
def drop_first(heap: Indices, count: int, keys: Floats) -> None:
    """Take the first of ``count`` rows out."""
    count -= 1
    last = heap[count]
    key = keys[last]
    place = 0
    while True:
        child = 2 * place + 1
        if child >= count:
            break
        if child + 1 < count and keys[heap[child + 1]] < keys[heap[child]]:
            child += 1
        if keys[heap[child]] >= key:
            break
        heap[place] = heap[child]
        place = child
    heap[place] = last
