from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.steiner.meeting import meet, meeting_length

COORDINATE = st.floats(-10, 10).map(lambda value: round(value, 3))
CORNERS = st.lists(st.tuples(COORDINATE, COORDINATE, COORDINATE), min_size=3, max_size=3)


def place_of(corners: Sequence[Sequence[float]]) -> tuple[Floats, float]:
    at = np.zeros((4, 3))
    at[:3] = np.array(corners)
    length = meet(at, 0, 1, 2, 3)
    return at, length


def test_the_corners_of_an_equilateral_triangle_meet_in_its_middle() -> None:
    at, length = place_of([[0, 0, 0], [1, 0, 0], [0.5, sqrt(0.75), 0]])
    assert at[3] == pytest.approx([0.5, sqrt(0.75) / 3, 0], abs=1e-15)
    assert length == pytest.approx(sqrt(3))


def test_points_meet_at_a_corner_of_120_degrees_or_more() -> None:
    at, length = place_of([[-1, 0.1, 0], [0, 0, 0], [1, 0.1, 0]])
    assert at[3].tolist() == [0, 0, 0]
    assert length == pytest.approx(2 * sqrt(1.01))


@pytest.mark.parametrize("corners", [[[1, 2, 3]] * 3, [[0, 0, 0], [0, 0, 0], [1, 0, 0]]])
def test_coincident_points_meet_where_they_are(corners: list[list[float]]) -> None:
    at, length = place_of(corners)
    assert at[3].tolist() == corners[0]
    assert length == np.linalg.norm(at[2] - at[0])


@given(CORNERS)
def test_the_length_is_that_of_three_arms(corners: list[tuple[float, float, float]]) -> None:
    at, length = place_of(corners)
    arms = np.linalg.norm(at[:3] - at[3], axis=1).sum()
    assert length == pytest.approx(arms, rel=1e-7, abs=1e-12)
    assert length == meeting_length(at, 0, 1, 2)


@given(CORNERS, st.tuples(COORDINATE, COORDINATE, COORDINATE), st.sampled_from([1.0, 1e-2, 1e-4]))
def test_no_other_place_is_better(
    corners: list[tuple[float, float, float]],
    direction: tuple[float, float, float],
    share: float,
) -> None:
    at, length = place_of(corners)
    other = at[3] + share * np.array(direction)
    assert np.linalg.norm(at[:3] - other, axis=1).sum() >= length - 1e-9
