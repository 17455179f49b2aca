from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.placement.balls import ABOVE_LABEL, FRONT, spread_on_balls, towards


@given(st.integers(1, 30), st.integers(0, 10**6), st.booleans())
def test_ends_are_far_enough_apart_where_there_is_room(
    count: int, seed: int, labelled: bool
) -> None:
    chance = np.random.default_rng(seed)
    wanted = chance.normal(size=(count, 3)) + np.array([3.0, 0.0, 0.0])
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    found = spread_on_balls(
        wanted,
        np.array([0, count]),
        np.array([0.3]),
        np.zeros(count, dtype=np.bool_),
        np.array([labelled]),
    )
    assert np.linalg.norm(found, axis=1) == pytest.approx(np.ones(count))
    apart = np.linalg.norm(found[:, None] - found[None], axis=2)[np.triu_indices(count, 1)]
    assert (apart > 0.29).all()
    if labelled and count > 1:
        assert ((found[:, 1] >= FRONT - 1e-9) | (found[:, 2] >= ABOVE_LABEL)).all()


def test_an_end_that_is_held_stays_and_others_make_way() -> None:
    wanted = np.tile([1.0, 0.0, 0.0], (3, 1))
    found = spread_on_balls(
        wanted,
        np.array([0, 3]),
        np.array([0.5]),
        np.array([True, False, False]),
        np.array([False]),
    )
    assert found[0].tolist() == [1.0, 0.0, 0.0]
    assert (np.linalg.norm(found[1:] - found[0], axis=1) > 0.49).all()


def test_an_end_leads_to_what_is_near_rather_than_to_what_is_far() -> None:
    places = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 50.0]])
    way = towards(places, np.array([0, 3]))[0]
    assert way[0] > 10 * way[2] > 0.0
