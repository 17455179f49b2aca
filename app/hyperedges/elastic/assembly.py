"""A routing from cubics along chains."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.fitting import Pieces
from app.hyperedges.routing import Routing

SHORTEST = 1e-12
"""Handles shorter than this, in document units, have no direction."""


def routing_of(pieces: Pieces, x: Floats, chains: Chains) -> Routing:
    """The routing that cubics along all chains make; join planes as they come out."""
    hyperedges = len(chains.radii)
    owners = chains.owners[pieces.chains]
    segment_starts = np.searchsorted(owners, np.arange(hyperedges + 1))
    is_last = np.ones(len(owners), dtype=np.bool_)
    is_last[:-1] = pieces.chains[1:] != pieces.chains[:-1]
    is_first = np.roll(is_last, 1)
    attachments = np.diff(chains.attachment_starts)
    inner = np.diff(chains.join_starts)
    bends = np.flatnonzero(~is_last)
    counts = np.bincount(owners[bends], minlength=hyperedges)
    ranks = np.arange(len(bends)) - (np.cumsum(counts) - counts)[owners[bends]]
    ends = np.empty((len(owners), 2), dtype=np.int64)
    ends[is_first, 0] = chains.local_ends[pieces.chains[is_first], 0]
    ends[is_last, 1] = chains.local_ends[pieces.chains[is_last], 1]
    ends[bends, 1] = (attachments + inner)[owners[bends]] + ranks
    ends[bends + 1, 0] = ends[bends, 1]
    join_starts = np.concatenate([[0], np.cumsum(inner + counts)])
    positions, tangents = np.empty((join_starts[-1], 3)), np.empty((join_starts[-1], 3))
    of = np.repeat(np.arange(hyperedges), inner)
    rows = join_starts[of] + np.arange(len(of)) - chains.join_starts[of]
    positions[rows], tangents[rows] = x[: len(of)], pieces.tangents
    rows = (join_starts[:-1] + inner)[owners[bends]] + ranks
    positions[rows] = pieces.curves[bends, 3]
    tangents[rows] = _tangents(pieces.curves, bends)
    return Routing(
        control_points=np.ascontiguousarray(pieces.curves),
        segment_starts=segment_starts,
        segment_ends=ends,
        join_positions=positions,
        join_tangents=tangents,
        join_starts=join_starts,
        join_planes=_planes(pieces, x, chains, segment_starts),
        radii=chains.radii,
    )


def _tangents(curves: Floats, bends: Indices) -> Floats:
    """Unit tangents (k, 3) between the cubics ``bends`` (k,) and those after them.

    Where a handle has no length that of the next one, the whole cubic, or x stand in.
    """
    found = np.tile([1.0, 0.0, 0.0], (len(bends), 1))
    last, after = curves[bends], curves[bends + 1]
    for way in (last[:, 3] - last[:, 0], after[:, 1] - after[:, 0], last[:, 3] - last[:, 2]):
        lengths = np.linalg.norm(way, axis=1)
        long = lengths > SHORTEST
        found[long] = way[long] / lengths[long, None]
    return found


def _planes(pieces: Pieces, x: Floats, chains: Chains, starts: Indices) -> Floats:
    """Mean heights of joins, (h,); tops of curves between two attachments; or what was given."""
    if len(chains.radii) == 0:
        return np.zeros(0)
    counts = np.diff(chains.join_starts)
    of = np.repeat(np.arange(len(counts)), counts)
    means = np.bincount(of, weights=x[: len(of), 2], minlength=len(counts)) / np.maximum(counts, 1)
    tops = np.maximum.reduceat(pieces.curves[:, [0, 3], 2].max(axis=1), starts[:-1])
    planes = np.where(counts > 0, means, tops)
    return np.where(np.isnan(chains.heights), planes, chains.heights)
