"""The curves of all hyperedges: what layout hands to the tubes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of


@dataclass(frozen=True, slots=True, eq=False)
class Routing:
    """Segments and joins of h hyperedges; those of one hyperedge lie together.

    A hyperedge of N attachments has N - 2 joins of three segments, and 2(N - 2) + 1 segments: one
    more for each of its bends, joins of two segments at which a curve goes around something. The
    paper's curves have no bends. Segments of hyperedge k are ``segment_starts[k]`` to
    ``segment_starts[k + 1]``; its joins, then its bends, likewise by ``join_starts`` (both
    (h + 1,)).

    ``control_points`` (s, 4, 3), document units, z up. ``segment_ends`` (s, 2): what a segment
    begins and ends at, numbered within its hyperedge: 0 to N - 1 are its attachments in the order
    of the document, then come its joins (the paper's in the order in which CURVES makes them) and
    its bends. ``join_positions`` (j, 3); ``join_tangents`` (j, 3), unit vectors common to all
    segments of a join. ``join_planes`` (h,), world z. ``radii`` (h,). ``is_elastic``: whether the
    curves were found by relaxation, and so are those of what an edit adds.
    """

    control_points: Floats
    segment_starts: Indices
    segment_ends: Indices
    join_positions: Floats
    join_tangents: Floats
    join_starts: Indices
    join_planes: Floats
    radii: Floats
    is_elastic: bool = False

    @staticmethod
    def nothing() -> Routing:
        """Of no hyperedges."""
        none, places = np.zeros(1, dtype=np.int64), np.zeros((0, 3))
        return Routing(
            control_points=np.zeros((0, 4, 3)),
            segment_starts=none,
            segment_ends=np.zeros((0, 2), dtype=np.int64),
            join_positions=places,
            join_tangents=places,
            join_starts=none,
            join_planes=np.zeros(0),
            radii=np.zeros(0),
        )

    @property
    def attachment_counts(self) -> Indices:
        """How many attachments each hyperedge has, (h,): a tree's leaves."""
        return np.diff(self.segment_starts) - np.diff(self.join_starts) + 1

    def part(self, hyperedges: Indices) -> Routing:
        """The routing of ``hyperedges`` (k,) alone, in that order."""
        segments = rows_of(self.segment_starts, hyperedges)
        joins = rows_of(self.join_starts, hyperedges)
        return Routing(
            control_points=self.control_points[segments],
            segment_starts=starts_of(np.diff(self.segment_starts)[hyperedges]),
            segment_ends=self.segment_ends[segments],
            join_positions=self.join_positions[joins],
            join_tangents=self.join_tangents[joins],
            join_starts=starts_of(np.diff(self.join_starts)[hyperedges]),
            join_planes=self.join_planes[hyperedges],
            radii=self.radii[hyperedges],
            is_elastic=self.is_elastic,
        )
