"""Curves that are kept, as relaxation and proof see them."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.box_tree import meeting_any, plant
from app.hyperedges.elastic.beads import Fixed
from app.hyperedges.elastic.faults import Curves
from app.hyperedges.routing import Routing
from app.placement.placement import Placement

PIECE = 3.0
"""Length of the straight pieces of a curve, over the tube's radius."""

MOST_PIECES = 64

BESIDE, MARGIN = 0.5, 20.0
"""Kept curves count as far from attachments as this times the span of these, and so many radii."""


def curves_of(kept: Routing, hyperedges: int) -> Curves:
    """The curves of ``kept`` hyperedges, which are numbered from ``hyperedges`` on."""
    owners = np.repeat(np.arange(len(kept.radii)), np.diff(kept.segment_starts))
    return Curves.of(kept.control_points, owners + hyperedges, kept.radii[owners])


def fixed_beside(curves: Curves, placement: Placement, chosen: Indices) -> Fixed:
    """Polylines along those of ``curves`` that the hyperedges ``chosen`` (k,) may come near to."""
    rows = _beside(curves, placement, chosen)
    points, radii = curves.points[rows], curves.radii[rows]
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=2).sum(axis=1)
    counts = np.clip(np.ceil(lengths / (PIECE * radii)), 1, MOST_PIECES).astype(np.int64)
    starts = starts_of(counts + 1)
    of = np.repeat(np.arange(len(rows)), counts + 1)
    t = ((np.arange(starts[-1]) - starts[of]) / counts[of])[:, None]
    p, s = points[of], 1.0 - t
    positions = s**3 * p[:, 0] + 3 * s**2 * t * p[:, 1] + 3 * s * t**2 * p[:, 2] + t**3 * p[:, 3]
    firsts = np.delete(np.arange(starts[-1]), starts[1:] - 1)
    segments = np.stack([firsts, firsts + 1], axis=1)
    return Fixed(positions, segments, curves.owners[rows][of[firsts]], radii[of[firsts]])


def _beside(curves: Curves, placement: Placement, chosen: Indices) -> Indices:
    starts = placement.attachment_starts
    positions = placement.attachment_positions[rows_of(starts, chosen)]
    begins = starts_of(np.diff(starts)[chosen])[:-1]
    if len(curves.owners) == 0 or len(chosen) == 0:
        return np.zeros(0, dtype=np.int64)
    lows: Floats = np.minimum.reduceat(positions, begins, axis=0)
    highs: Floats = np.maximum.reduceat(positions, begins, axis=0)
    reach = BESIDE * np.linalg.norm(highs - lows, axis=1) + MARGIN * placement.radii[chosen]
    asked = np.zeros((len(chosen), 8))
    asked[:, :3], asked[:, 4:7] = lows - reach[:, None], highs + reach[:, None]
    return np.flatnonzero(meeting_any(plant(asked), curves.boxes))
