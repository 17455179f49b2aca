"""The trees of hyperedges as chains between joins and attachments."""

from __future__ import annotations

from typing import NamedTuple

from app.arrays import Flags, Floats, Indices


class Chains(NamedTuple):
    """c chains: the edges of h trees, over nodes: j joins first, then a attachments.

    ``ends`` (c, 2) are nodes, ``local_ends`` (c, 2) the same numbered within the hyperedge: its
    attachments first, then its joins. ``owners`` (c,), ascending: the hyperedges that chains are
    of. ``join_starts`` and ``attachment_starts`` (h + 1,): where the joins and the attachments of
    each hyperedge begin, each numbered from 0.

    ``positions`` and unit, outward ``directions`` (a, 3) of attachments, document units. ``radii``
    (h,) are the tubes'. ``hung`` (h,): whether the hyperedge is an arch, and ``ways`` (h, 3) where
    it rises to, a unit vector: upwards from the ground, before or behind a sheet. ``heights`` (h,):
    where its joins are held, NaN where they are free. ``floors`` (h,): the least height of beads.
    """

    ends: Indices
    local_ends: Indices
    owners: Indices
    join_starts: Indices
    attachment_starts: Indices
    positions: Floats
    directions: Floats
    radii: Floats
    hung: Flags
    ways: Floats
    heights: Floats
    floors: Floats

    @property
    def joins(self) -> int:
        """How many joins there are."""
        return int(self.join_starts[-1])
