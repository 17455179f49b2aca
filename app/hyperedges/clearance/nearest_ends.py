"""Which of a hyperedge's attachments is nearest to a place."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.placement.placement import Placement


def nearest_ends(
    placement: Placement, hyperedges: Indices, places: Floats
) -> tuple[Indices, Floats]:
    """The attachments (n,) of the ``hyperedges`` (n,) nearest to ``places`` (n, 3), and how near.

    Of several as near the first one. Distances (n,) are in document units.
    """
    if len(hyperedges) == 0:
        return np.zeros(0, dtype=np.int64), np.zeros(0)
    rows = rows_of(placement.attachment_starts, hyperedges)
    counts = np.diff(placement.attachment_starts)[hyperedges]
    of = np.repeat(np.arange(len(hyperedges)), counts)
    far = np.linalg.norm(placement.attachment_positions[rows] - places[of], axis=1)
    order = np.lexsort((rows, far, of))[starts_of(counts)[:-1]]
    return rows[order], far[order]
