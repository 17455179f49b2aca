from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.box_tree import TooManyPairs, meeting, meeting_any, plant


def boxes(chance: np.random.Generator, count: int, layers: int) -> Floats:
    lows = np.round(chance.uniform(0, 9, (count, 3)))
    sizes = np.round(chance.exponential(1.0, (count, 3)))
    layer = chance.integers(0, layers, (count, 1))
    return np.hstack([lows, layer, lows + sizes, layer]).astype(np.float64)


def meet(first: Floats, second: Floats) -> bool:
    return bool((first[:4] <= second[4:]).all() and (second[:4] <= first[4:]).all())


@pytest.mark.parametrize("layers", [1, 3])
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 70))
@settings(max_examples=30)
def test_boxes_of_two_sets_meet_as_in_a_plain_loop(layers: int, seed: int, count: int) -> None:
    chance = np.random.default_rng(seed)
    some, others = boxes(chance, 20, layers), boxes(chance, count, layers)
    groups = chance.integers(0, 3, 20), chance.integers(0, 3, count)
    asking = np.flatnonzero(chance.random(20) < 0.7)
    expected = [
        [i, j]
        for i in asking.tolist()
        for j in range(count)
        if groups[0][i] != groups[1][j] and meet(some[i], others[j])
    ]
    assert meeting(plant(others), some, asking, groups).tolist() == expected


@pytest.mark.parametrize("layers", [1, 3])
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 70))
@settings(max_examples=30)
def test_boxes_that_meet_any_are_those_of_pairs(layers: int, seed: int, count: int) -> None:
    chance = np.random.default_rng(seed)
    some, others = boxes(chance, 20, layers), boxes(chance, count, layers)
    numbers = np.arange(20)
    pairs = meeting(plant(others), some, numbers, (numbers, np.full(count, -1)))
    found = np.flatnonzero(meeting_any(plant(others), some))
    np.testing.assert_array_equal(found, np.unique(pairs[:, 0]))


def test_no_more_pairs_are_listed_than_is_allowed() -> None:
    some = np.tile([0.0, 0, 0, 0, 1, 1, 1, 0], (12, 1))
    numbers, all_ = np.arange(12), np.ones(12, dtype=np.bool_)
    pairs = 12 * 11 // 2
    found = meeting(plant(some), some, numbers, (numbers, numbers), all_, most=pairs)
    assert len(found) == pairs
    with pytest.raises(TooManyPairs):
        meeting(plant(some), some, numbers, (numbers, numbers), all_, most=pairs - 1)


@pytest.mark.parametrize("layers", [1, 3])
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 70))
@settings(max_examples=30)
def test_boxes_of_one_set_meet_each_other_once(layers: int, seed: int, count: int) -> None:
    chance = np.random.default_rng(seed)
    some = boxes(chance, count, layers)
    numbers = np.arange(count)
    for asked in (np.ones(count, dtype=np.bool_), chance.random(count) < 0.5):
        expected = [
            [i, j]
            for i in range(count)
            for j in range(i + 1, count)
            if (asked[i] or asked[j]) and meet(some[i], some[j])
        ]
        asking = chance.permutation(np.flatnonzero(asked))
        found = meeting(plant(some), some, asking, (numbers, numbers), asked)
        assert found.tolist() == expected
