"""Which items a hyperedge may touch or pass: its own, their parts, and what contains them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Indices
from app.grouped import rows_from
from app.placement.placement import Placement
from app.solids.solid import Tray

MOST_PARTS = 32
"""A block that holds more is rather a container, and what it holds are no parts of it."""


def with_parts(items: Indices, placement: Placement) -> tuple[Indices, Indices]:
    """The ``items`` (a,) and their parts: which of the items (m,), and the item or part (m,).

    Parts are what a block or any other item but a tray holds, at any depth, such as small blocks
    that stand for its ports.
    """
    numbers = np.arange(len(items))
    wholes, parts = _parts(placement)
    firsts = np.searchsorted(wholes, items, side="left")
    counts = np.searchsorted(wholes, items, side="right") - firsts
    rows = np.concatenate([numbers, np.repeat(numbers, counts)])
    return rows, np.concatenate([items, parts[rows_from(firsts, counts)]])


def _parts(placement: Placement) -> tuple[Indices, Indices]:
    """Items that have parts, ascending, and the parts, (k,) each."""
    parents = placement.parents
    found = [np.zeros((0, 2), dtype=np.int64)]
    below = np.arange(len(parents))
    above = parents
    while len(above):
        below, above = below[above >= 0], above[above >= 0]
        found.append(np.stack([above, below], axis=1))
        above = parents[above]
    wholes, parts = np.concatenate(found).T
    is_tray = np.array([isinstance(solid, Tray) for solid in placement.solids], dtype=np.bool_)
    few = np.bincount(wholes, minlength=len(is_tray)) <= MOST_PARTS
    kept = few[wholes] & ~is_tray[wholes]
    wholes, parts = wholes[kept], parts[kept]
    order = np.lexsort((parts, wholes))
    return wholes[order], parts[order]


def attached_items(placement: Placement) -> Indices:
    """Which hyperedge attaches to which item, or to what it is a part of: pairs (k, 2), sorted."""
    starts = placement.attachment_starts
    hyperedges = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    rows, items = with_parts(placement.attachment_items, placement)
    return _sorted_once(hyperedges[rows], items)


def containing_items(placement: Placement) -> Indices:
    """Which item contains one that a hyperedge attaches to, at any depth: pairs (k, 2), sorted."""
    starts = placement.attachment_starts
    hyperedges = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    hyperedges, items = _sorted_once(hyperedges, placement.attachment_items).T
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
