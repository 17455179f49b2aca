from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.scene.color import (
    difference,
    hex_of,
    linear_of,
    oklab_of,
    srgb_from_linear,
    srgb_from_oklab,
    srgb_of,
)

colors = st.tuples(*[st.integers(0, 255)] * 3).map(lambda rgb: "#{:02x}{:02x}{:02x}".format(*rgb))


@given(colors)
def test_a_colour_survives_every_way_there_and_back(color: str) -> None:
    srgb = srgb_of(color)
    assert hex_of(srgb) == color
    assert hex_of(srgb_from_linear(linear_of(srgb))) == color
    assert hex_of(srgb_from_oklab(oklab_of(srgb))) == color


def test_short_colours_mean_each_digit_twice() -> None:
    assert hex_of(srgb_of("#A3f")) == "#aa33ff"


@pytest.mark.parametrize(
    ("color", "linear"), [("#000000", 0.0), ("#808080", 0.21586050011), ("#ffffff", 1.0)]
)
def test_light_is_linear_as_the_standard_says(color: str, linear: float) -> None:
    assert linear_of(srgb_of(color)) == pytest.approx([linear] * 3, abs=1e-10)


@pytest.mark.parametrize(
    ("color", "oklab"),
    [
        # Values of CSS Color 4's reference implementation.
        ("#ff0000", (0.62796, 0.22486, 0.12585)),
        ("#00ff00", (0.86644, -0.23389, 0.17950)),
        ("#0000ff", (0.45201, -0.03246, -0.31153)),
    ],
)
def test_oklab_of_the_primaries(color: str, oklab: tuple[float, float, float]) -> None:
    assert oklab_of(srgb_of(color)) == pytest.approx(oklab, abs=1e-4)


def test_a_difference_is_the_same_both_ways_and_none_to_itself() -> None:
    one, other = srgb_of("#4c7ddd"), srgb_of("#e8661c")
    assert difference(one, other) == pytest.approx(difference(other, one))
    assert difference(one, one) == 0.0


def test_whole_arrays_are_turned_at_once() -> None:
    many = np.array([srgb_of("#4c7ddd"), srgb_of("#e8661c")])
    assert oklab_of(many)[1] == pytest.approx(oklab_of(many[1]))
