"""Long sweeps at joins, wherever curves stay clear with them."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices
from app.hyperedges.elastic.assembly import routing_of
from app.hyperedges.elastic.beads import SPACING
from app.hyperedges.elastic.faults import find_faults
from app.hyperedges.elastic.fitting import fit
from app.hyperedges.elastic.repair import Mended, troubled
from app.hyperedges.elastic.run import Progress, State, Surroundings
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import StoppedError

LENGTHS = (36.0, 24.0, 14.0, 8.0, 0.0)
"""Of the cubics at joins, over the tube's radius: the first are tried first."""

OF_CHAIN, BETWEEN_JOINS = 0.8, 0.45
"""The share of a chain that a sweep takes at most."""


def lengthen(mended: Mended, around: Surroundings, progress: Progress) -> Routing:
    """Curves with sweeps at their joins as long as can be.

    A hyperedge whose sweeps make a fault gets shorter ones, and with it what it comes too near to.
    Where ``progress`` stops it, curves are left as they are.
    """
    try:
        return _lengthened(mended, around, progress)
    except StoppedError:
        return mended.routing


def _lengthened(mended: Mended, around: Surroundings, progress: Progress) -> Routing:
    state = mended.state
    hyperedges = len(state.chains.radii)
    levels = np.zeros(hyperedges, dtype=np.int64)
    active = np.ones(hyperedges, dtype=np.bool_)
    pieces = None
    while True:
        progress()
        sweeps = _sweeps(state, levels)
        pieces = fit(state.x, state.beads, state.chains, state.stems, sweeps, pieces, active)
        routing = routing_of(pieces, state.x, state.chains)
        faults = find_faults(
            routing, around.kept, around.proven, around.clearance, active, progress
        )
        active = troubled(faults, routing, hyperedges) & (levels < len(LENGTHS) - 1)
        if not active.any():
            return routing
        levels[active] += 1


def _sweeps(state: State, levels: Indices) -> Indices:
    """Over how many segments the cubics at both ends of each chain go, (c, 2)."""
    chains = state.chains
    counts = np.diff(state.beads.segment_starts)
    at_join = chains.ends < chains.joins
    shares = np.where(at_join.all(axis=1), BETWEEN_JOINS, OF_CHAIN)
    wanted = np.array(LENGTHS)[levels[chains.owners]] / SPACING
    found = np.minimum(np.floor(shares * counts), np.rint(wanted)).astype(np.int64)
    return np.where(at_join, np.maximum(found, 1)[:, None], 1)
