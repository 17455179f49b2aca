"""Rows of groups that lie one after another in shared arrays."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices


def rows_from(firsts: Indices, counts: Indices) -> Indices:
    """The numbers from each first on, so many each, one group after another.

    >>> rows_from(np.array([3, 0]), np.array([3, 2])).tolist()
    [3, 4, 5, 0, 1]
    """
    before = np.cumsum(counts) - counts
    return np.asarray(np.arange(int(counts.sum())) + np.repeat(firsts - before, counts))


def rows_of(starts: Indices, chosen: Indices) -> Indices:
    """The rows of the ``chosen`` groups; those of group k are ``starts[k]`` to ``starts[k + 1]``.

    >>> rows_of(np.array([0, 2, 3, 6]), np.array([2, 0])).tolist()
    [3, 4, 5, 0, 1]
    """
    return rows_from(starts[chosen], starts[chosen + 1] - starts[chosen])


def starts_of(counts: Indices) -> Indices:
    """Where groups of such sizes start, and where the last ends.

    >>> starts_of(np.array([2, 1, 3])).tolist()
    [0, 2, 3, 6]
    """
    return np.concatenate([[0], np.cumsum(counts)])
