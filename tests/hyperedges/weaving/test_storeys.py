from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.weaving.crossings import Crossings
from app.hyperedges.weaving.storeys import first_fit, stack

CLEARANCE = 0.05
HYPEREDGES = 12

seeds = st.integers(0, 2**32 - 1)


def entangled(seed: int) -> tuple[Crossings, Floats, Floats]:
    """Crossings, lows and radii of hyperedges of which a third cross each other."""
    chance = np.random.default_rng(seed)
    crosses = np.triu(chance.random((HYPEREDGES, HYPEREDGES)) < 0.33, 1)
    crosses |= crosses.T
    starts = np.concatenate([[0], np.cumsum(crosses.sum(axis=1))])
    lows, radii = chance.uniform(1, 3, HYPEREDGES), chance.uniform(0.1, 0.2, HYPEREDGES)
    return Crossings(starts, np.nonzero(crosses)[1]), lows, radii


def closest(crossings: Crossings, planes: Floats, radii: Floats) -> float:
    """How much farther apart than needed crossing hyperedges are, at least."""
    owners = np.repeat(np.arange(HYPEREDGES), np.diff(crossings.starts))
    others = crossings.neighbours
    apart = np.abs(planes[owners] - planes[others])
    return float((apart - radii[owners] - radii[others] - CLEARANCE).min(initial=np.inf))


@given(seeds)
def test_crossing_hyperedges_get_planes_far_enough_apart(seed: int) -> None:
    crossings, lows, radii = entangled(seed)
    order, tops = np.argsort(lows), np.full(HYPEREDGES, np.inf)
    planes = first_fit(crossings, order, lows, tops, radii, CLEARANCE)
    assert (planes >= lows).all()
    assert closest(crossings, planes, radii) >= 0


@given(seeds)
def test_stacking_keeps_the_order_and_what_is_fixed(seed: int) -> None:
    crossings, lows, radii = entangled(seed)
    order = np.random.default_rng(seed).permutation(HYPEREDGES)
    fixed = np.zeros(HYPEREDGES, dtype=np.bool_)
    planes = stack(crossings, order, lows, fixed, radii, CLEARANCE)
    assert closest(crossings, planes, radii) >= 0
    ranks = np.argsort(order)
    for k in range(HYPEREDGES):
        for other in crossings.neighbours[crossings.starts[k] : crossings.starts[k + 1]]:
            assert (ranks[k] < ranks[other]) == (planes[k] < planes[other])
    fixed[3] = True
    assert stack(crossings, order, lows, fixed, radii, CLEARANCE)[3] == lows[3]


def test_who_crosses_nobody_stays_low() -> None:
    alone = Crossings(np.zeros(4, dtype=np.int64), np.zeros(0, dtype=np.int64))
    lows = np.array([2.0, 1.0, 1.0])
    tops = np.full(3, np.inf)
    planes = first_fit(alone, np.arange(3), lows, tops, np.full(3, 0.1), CLEARANCE)
    assert planes.tolist() == lows.tolist()
