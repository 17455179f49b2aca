"""What is too large to be routed by relaxation: it is routed in planes."""

from __future__ import annotations

import numpy as np

from app.hyperedges.elastic.beads import SPACING
from app.placement.placement import Placement

MOST_BEADS = 1_000_000
"""Some gigabyte of memory."""

WIDEST = 30.0
"""Largest clearance over the radius of the thinnest tube: beyond that, each bead of it would have
too many others to keep from."""


def can_relax(placement: Placement, clearance: float) -> bool:
    """Whether the hyperedges of a placement have as many beads, and as near, as is possible.

    The number of beads is estimated by a star from the middle of each hyperedge's attachments.
    """
    starts, radii = placement.attachment_starts, placement.radii
    if len(radii) == 0:
        return True
    if clearance > WIDEST * float(radii.min()):
        return False
    counts = np.diff(starts)
    owners = np.repeat(np.arange(len(radii)), counts)
    positions = placement.attachment_positions
    middles = np.add.reduceat(positions, starts[:-1], axis=0) / counts[:, None]
    lengths = np.linalg.norm(positions - middles[owners], axis=1)
    beads = lengths / (SPACING * radii[owners])
    return bool(beads.sum() <= MOST_BEADS)
