"""Pairs that come too near to each other, and where they do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices


@dataclass(frozen=True, slots=True)
class Contact:
    """The nearest place of a hyperedge, ``first``, and another or an item, ``second``.

    ``lower`` and ``upper`` are bounds of the distance between the surfaces, negative where they
    pass through each other; ``place`` is halfway between them.
    """

    with_item: bool
    first: int
    second: int
    place: tuple[float, float, float]
    lower: float
    upper: float


@dataclass(frozen=True, slots=True, eq=False)
class Conflicts:
    """Pairs that are not proven to be clear, each once, at the nearest place.

    ``with_items`` (k,): whether ``second`` (k,) is an item or a hyperedge with a larger number than
    ``first`` (k,); pairs of hyperedges come first, sorted.
    ``places`` (k, 3); ``lower`` and ``upper`` (k,): bounds of the distance between the surfaces.
    """

    with_items: NDArray[np.bool_]
    first: Indices
    second: Indices
    places: Floats
    lower: Floats
    upper: Floats

    def __len__(self) -> int:
        return len(self.first)


def kept(conflicts: Conflicts, rows: Indices) -> Conflicts:
    """The ``rows`` (m,) of all."""
    return Conflicts(
        conflicts.with_items[rows],
        conflicts.first[rows],
        conflicts.second[rows],
        conflicts.places[rows],
        conflicts.lower[rows],
        conflicts.upper[rows],
    )


def once(all_pairs: Conflicts, wanted: NDArray[np.bool_]) -> Conflicts:
    """The nearest of the wanted rows for each pair, sorted."""
    rows = np.flatnonzero(wanted)
    chosen = kept(all_pairs, rows)
    order = np.lexsort((chosen.lower, chosen.second, chosen.first, chosen.with_items))
    names = np.stack([chosen.with_items, chosen.first, chosen.second])[:, order]
    new = np.ones(len(order), dtype=np.bool_)
    new[1:] = (names[:, 1:] != names[:, :-1]).any(axis=0)
    return kept(chosen, order[new])


def nearest_of(contacts: Conflicts) -> Contact:
    """The one that is nearest; there is one at least."""
    row = int(contacts.lower.argmin())
    x, y, z = contacts.places[row].tolist()
    return Contact(
        with_item=bool(contacts.with_items[row]),
        first=int(contacts.first[row]),
        second=int(contacts.second[row]),
        place=(x, y, z),
        lower=float(contacts.lower[row]),
        upper=float(contacts.upper[row]),
    )
