"""The circle that is swept: enough sides for the tolerance, and mirror images to the bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.tubes.circle import (
    FEWEST_SIDES,
    MOST_SIDES,
    cap_rings,
    circles,
    latitudes,
    sides_of,
    tolerances_of,
)

ALL_SIDES = range(FEWEST_SIDES, MOST_SIDES + 1, 2)


@given(st.floats(1e-3, 1e5), st.floats(1e-6, 10))
def test_sides_are_even_and_as_few_as_the_tolerance_allows(radius: float, tolerance: float) -> None:
    sides = int(sides_of(np.array([radius]), tolerance)[0])
    allowed = float(tolerances_of(np.array([radius]), tolerance)[0]) * (1 + 1e-6)
    assert sides % 2 == 0
    assert FEWEST_SIDES <= sides <= MOST_SIDES
    assert radius * (1 - np.cos(np.pi / sides)) <= allowed
    if sides > FEWEST_SIDES:
        assert radius * (1 - np.cos(np.pi / (sides - 2))) > tolerance * (1 - 1e-6)


def test_hand_worked_sides() -> None:
    assert sides_of(np.array([1.0, 1.0 / (1 - np.cos(np.pi / 12))]), 1.0).tolist() == [4, 12]
    assert sides_of(np.array([0.1]), 0.002).tolist() == [16]


@pytest.mark.parametrize("sides", ALL_SIDES)
def test_circles_are_round_and_their_mirror_images_equal_to_the_bit(sides: int) -> None:
    cosines, sines = circles()[sides, :, :sides]
    angles = 2 * np.pi * np.arange(sides) / sides
    np.testing.assert_allclose(cosines, np.cos(angles), atol=1e-7)
    np.testing.assert_allclose(sines, np.sin(angles), atol=1e-7)
    back = -np.arange(sides) % sides
    np.testing.assert_array_equal(cosines[back], cosines)
    np.testing.assert_array_equal(sines[back], -sines)
    half_on = (np.arange(sides) + sides // 2) % sides
    np.testing.assert_array_equal(cosines[half_on], -cosines)
    np.testing.assert_array_equal(circles()[sides, :, sides : 2 * sides], [cosines, sines])


@pytest.mark.parametrize("sides", ALL_SIDES)
def test_rings_of_a_rounded_end_are_no_farther_apart_than_its_sides(sides: int) -> None:
    rings = int(cap_rings(np.array([sides]))[0])
    cosines, sines = latitudes()[sides, :, :rings]
    steps = np.diff(np.arctan2(sines, cosines), prepend=np.pi / 2, append=0.0)
    assert (np.abs(steps) <= 2 * np.pi / sides + 1e-12).all()
    np.testing.assert_allclose(steps, steps[0])
