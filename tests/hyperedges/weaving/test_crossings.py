from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.weaving.crossings import MARGIN, Crossings, find_crossings, squared_gap

CLEARANCE = 0.05
NONE = (np.zeros((0, 2, 2)), np.zeros(0, dtype=np.int64))

seeds = st.integers(0, 2**32 - 1)


def pairs_of(found: Crossings) -> set[tuple[int, int]]:
    counts = np.diff(found.starts)
    return set(
        zip(
            np.repeat(np.arange(len(counts)), counts).tolist(),
            found.neighbours.tolist(),
            strict=True,
        )
    )


def sampled_gap(one: Floats, other: Floats) -> float:
    t = np.linspace(0, 1, 201)[:, None]
    a, b = one[0] + t * (one[1] - one[0]), other[0] + t * (other[1] - other[0])
    return float(np.linalg.norm(a[:, None] - b[None], axis=2).min())


@given(seeds)
def test_crossings_are_all_pairs_that_come_too_near(seed: int) -> None:
    chance = np.random.default_rng(seed)
    legs = chance.uniform(0, 6, (14, 2, 2))
    owners = chance.integers(0, 6, 14)
    radii = chance.uniform(0.1, 0.2, 6)
    expected = {
        (k, other)
        for i, k in enumerate(owners.tolist())
        for j, other in enumerate(owners.tolist())
        if k != other
        and squared_gap(legs[i], legs[j]) < (MARGIN * (radii[k] + radii[other] + CLEARANCE)) ** 2
    }
    assert pairs_of(find_crossings(legs, owners, *NONE, radii, CLEARANCE)) == expected
    # Half of them standing still: what crosses among those does not count.
    still = owners >= 3
    found = find_crossings(
        legs[~still], owners[~still], legs[still], owners[still], radii, CLEARANCE
    )
    assert pairs_of(found) == {pair for pair in expected if min(pair) < 3}


@given(seeds)
def test_gaps_of_legs_are_what_sampling_finds(seed: int) -> None:
    one, other = np.random.default_rng(seed).uniform(0, 3, (2, 2, 2))
    gap = float(np.sqrt(squared_gap(one, other)))
    assert gap <= sampled_gap(one, other) + 1e-12
    assert gap >= sampled_gap(one, other) - 0.03
