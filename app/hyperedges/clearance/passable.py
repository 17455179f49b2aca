"""Which items a hyperedge may pass or touch: those that it attaches to, and what contains these."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Indices
from app.placement.placement import Placement


def attached_items(placement: Placement) -> Indices:
    """Which hyperedge attaches to which item: pairs (k, 2), each once, sorted."""
    starts = placement.attachment_starts
    hyperedges = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    return _sorted_once(hyperedges, placement.attachment_items)


def containing_items(placement: Placement) -> Indices:
    """Which item contains one that a hyperedge attaches to, at any depth: pairs (k, 2), sorted."""
    hyperedges, items = attached_items(placement).T
    found = [np.zeros((0, 2), dtype=np.int64)]
    while len(items) and len(placement.parents):
        items = placement.parents[items]
        hyperedges, items = hyperedges[items >= 0], items[items >= 0]
        pairs = _sorted_once(hyperedges, items)
        hyperedges, items = pairs.T
        found.append(pairs)
    return _sorted_once(*np.concatenate(found).T)


def passable_items(placement: Placement) -> Indices:
    """Both together: pairs (k, 2) of a hyperedge and an item, each once, sorted."""
    return _sorted_once(*np.concatenate([attached_items(placement), containing_items(placement)]).T)


def are_among(pairs: Indices, some: Indices) -> NDArray[np.bool_]:
    """Which ``pairs`` (m, 2) are among ``some`` (k, 2), sorted."""
    count = int(max(pairs[:, 1].max(initial=0), some[:, 1].max(initial=0))) + 1
    keys = pairs[:, 0] * count + pairs[:, 1]
    known = np.append(some[:, 0] * count + some[:, 1], np.iinfo(np.int64).max)
    return np.asarray(known[np.searchsorted(known, keys)] == keys)


def _sorted_once(hyperedges: Indices, items: Indices) -> Indices:
    count = int(items.max(initial=0)) + 1
    return np.stack(np.divmod(np.unique(hyperedges * count + items), count), axis=1)
