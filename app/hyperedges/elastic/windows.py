"""Beads along cubics, and some beyond their ends."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices
from app.hyperedges.elastic.fitting import Pieces
from app.hyperedges.elastic.run import State


def windows(pieces: Pieces, state: State, segments: Indices, wider: int) -> tuple[Indices, Indices]:
    """Beads along the cubics ``segments`` (n,) and ``wider`` beyond: (n, w), -1 where none is.

    And the same as segments of chains.
    """
    beads = state.beads
    chain = pieces.chains[segments]
    counts = np.diff(beads.segment_starts)[chain]
    spans = pieces.spans[segments]
    most = int((spans[:, 1] - spans[:, 0]).max(initial=0)) + 2 * wider + 1
    step = spans[:, :1] - wider + np.arange(most)
    inside = (step >= 0) & (step <= counts[:, None]) & (step <= spans[:, 1:] + wider)
    bead = beads.starts[chain][:, None] + step - 1
    bead = np.where(step == 0, beads.ends[chain, 0][:, None], bead)
    bead = np.where(step == counts[:, None], beads.ends[chain, 1][:, None], bead)
    line = np.where(step < counts[:, None], beads.segment_starts[chain][:, None] + step, -1)
    return np.where(inside, bead, -1), np.where(inside, line, -1)
