"""From trees to curves: tubes grow while chains of beads are straightened and pushed apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.arrays import Floats
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.relaxation import Rates
from app.hyperedges.elastic.repair import Mended, mend, unmended
from app.hyperedges.elastic.run import Surroundings, run, spaced_anew, state_of
from app.hyperedges.elastic.start import curvatures_of, start_lines
from app.hyperedges.elastic.sweeps import lengthen
from app.hyperedges.stopping import StoppedError

Progress = Callable[[float], None]
"""Told which share of the work is done at least, from 0 to 1.

It may raise to end it; where it raises `StoppedError`, the best so far is what comes of it.
"""

THIN, HALF_GROWN = 0.25, 0.7
"""Shares of their distances that tubes keep at first, and when beads are spaced anew.

Thin ones slip past each other early, and grow apart late.
"""

STEPS = 80
"""Of each stage of growth, and of settling after it."""

GROWN = 60
"""Steps of the second stage after which tubes have their size."""

SOFT, STIFF = 60, 30
"""Steps that bend chains evenly, and that only push and smooth."""


def relaxed(
    chains: Chains, joins: Floats, around: Surroundings, progress: Progress = lambda _share: None
) -> Mended:
    """Curves along ``chains``, whose joins (j, 3) begin at ``joins``."""

    def at(share: float) -> Callable[[], None]:
        return lambda: progress(share)

    lines = start_lines(chains, joins)
    state = state_of(chains, lines, around.fixed, curvatures_of(chains))
    sweeps = np.ones((len(chains.ends), 2), dtype=np.int64)
    try:
        run(state, around, Rates(0.3, 0.28, THIN, HALF_GROWN, STEPS), STEPS, 1.15, at(0.0))
        state = spaced_anew(state, around.fixed)
        run(state, around, Rates(0.3, 0.28, HALF_GROWN, 1.0, GROWN), STEPS, 1.2, at(0.2))
        state = spaced_anew(state, around.fixed)
        run(state, around, Rates(0.12, 0.35), STEPS, 1.2, at(0.4))
        run(state, around, Rates(0.03, 0.4), SOFT, 1.2, at(0.6))
        run(state, around, Rates(0.01, 0.14), STIFF, 1.25, at(0.75))
    except StoppedError:
        return unmended(state, sweeps)
    mended = mend(state, around, sweeps, at(0.8))
    return replace(mended, routing=lengthen(mended, around, at(0.95)))
