"""The curves of all hyperedges: what layout hands to the tubes."""

from __future__ import annotations

from dataclasses import dataclass

from app.arrays import Floats, Indices


@dataclass(frozen=True, slots=True, eq=False)
class Routing:
    """Segments and joins of h hyperedges; those of one hyperedge lie together.

    A hyperedge of N attachments has 2(N - 2) + 1 segments and N - 2 joins. Its segments are
    ``segment_starts[k]`` to ``segment_starts[k + 1]``, in the order in which CURVES makes them;
    its joins likewise by ``join_starts`` (both (h + 1,)).

    ``control_points`` (s, 4, 3), document units, z up. ``segment_ends`` (s, 2): what a segment
    begins and ends at, numbered within its hyperedge: 0 to N - 1 are its attachments in the order
    of the document, N to 2N - 3 its joins in the order in which CURVES makes them.
    ``join_positions`` (j, 3); ``join_tangents`` (j, 3), unit vectors common to the three segments
    of a join, in the sense of the segment that leaves it. ``join_planes`` (h,), world z.
    ``radii`` (h,).
    """

    control_points: Floats
    segment_starts: Indices
    segment_ends: Indices
    join_positions: Floats
    join_tangents: Floats
    join_starts: Indices
    join_planes: Floats
    radii: Floats
