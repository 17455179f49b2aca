from __future__ import annotations

from collections.abc import Callable
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats, Singles
from app.scene.color import linear_of, oklab_of, srgb_of
from app.scene.materials import SURFACES
from app.scene.scene import TextureName
from app.scene.stone import stone
from app.scene.textures import MEAN, SIZE, texture, tint
from app.scene.wood import RINGS, wood
from tests.cost import check_costs_less

NAMES: tuple[TextureName, ...] = get_args(TextureName)
channels = st.floats(0, 1)


def linear(name: TextureName) -> Floats:
    return linear_of(texture(name) / 255)


@pytest.mark.parametrize("name", NAMES)
def test_a_texture_is_a_square_of_a_power_of_two_and_cannot_be_changed(name: TextureName) -> None:
    found = texture(name)
    assert found.shape == (SIZE, SIZE, 3)
    assert SIZE & (SIZE - 1) == 0
    assert found.dtype == np.uint8
    assert texture(name) is found
    with pytest.raises(ValueError, match="read-only"):
        found[0] = 0


@pytest.mark.parametrize("name", NAMES)
def test_the_mean_of_a_texture_is_grey_and_known(name: TextureName) -> None:
    assert linear(name).mean(axis=(0, 1)) == pytest.approx([MEAN] * 3, abs=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_a_texture_goes_on_over_its_rims(name: TextureName) -> None:
    found = linear(name).mean(axis=-1)
    for axis in (0, 1):
        inside = np.abs(np.diff(found, axis=axis)).mean(axis=1 - axis)
        across = np.abs(found.take(0, axis=axis) - found.take(-1, axis=axis)).mean()
        assert across <= 1.1 * inside.max()


@pytest.mark.parametrize("name", NAMES)
def test_the_colour_of_the_material_remains_recognisable(name: TextureName) -> None:
    natural = SURFACES[name].natural_color
    assert natural is not None
    red, green, blue = linear_of(srgb_of(natural)).tolist()
    shown = (linear(name) * tint((red, green, blue))).mean(axis=(0, 1))
    assert shown == pytest.approx([red, green, blue], rel=0.03)


def test_wood_is_far_smoother_along_its_grain_than_across() -> None:
    found = linear("wood").mean(axis=-1)
    along, across = (np.abs(np.diff(found, axis=axis)).mean() for axis in (1, 0))
    assert across > 6 * along


def test_wood_has_its_rings() -> None:
    """Late wood is a band of its own, darker and redder than the early wood beside it."""
    lines = wood(256)[:, ::16].reshape(256, -1, 3)
    red = lines[..., 0] - lines[..., 0].mean(axis=0)
    bands = ((red[:-1] >= 0) & (red[1:] < 0)).sum(axis=0)
    assert RINGS <= bands.mean() <= 2 * RINGS, "a few fibres are as dark"
    dark, light = (lines[red < -0.1], lines[red > 0.1])
    assert (dark[:, 0] / dark[:, 2]).mean() > 1.1 * (light[:, 0] / light[:, 2]).mean()


def test_stone_is_alike_in_both_directions_and_nearly_grey() -> None:
    found = stone(256).mean(axis=-1)
    down, across = (np.abs(np.diff(found, axis=axis)).mean() for axis in (0, 1))
    assert down == pytest.approx(across, rel=0.1)
    assert np.linalg.norm(oklab_of(texture("stone") / 255)[..., 1:], axis=-1).max() < 0.03


def test_stone_has_dark_speckles_in_light_feldspar() -> None:
    found = linear("stone").mean(axis=-1)
    assert 0.04 < (found < 0.2).mean() < 0.12
    assert (found > 0.75).mean() > 0.4


@pytest.mark.parametrize("make", [wood, stone])
def test_the_same_texture_is_made_each_time_and_soon(make: Callable[[int], Singles]) -> None:
    found = make(SIZE)
    assert np.array_equal(found, make(SIZE))
    # It costs about as much as five sines of each number in it; some processors are quick at these.
    check_costs_less(lambda: make(SIZE), lambda: _sines(found), times=60)


def _sines(values: Singles) -> None:
    np.sin(values.astype(np.float64))


@given(channels, channels, channels)
def test_tints_keep_their_hue_and_can_be_shown(red: float, green: float, blue: float) -> None:
    color = (red, green, blue)
    found = tint(color)
    assert max(found) <= 1 + 1e-12
    assert np.cross(found, color) == pytest.approx(np.zeros(3), abs=1e-12)
    if max(color) <= MEAN:
        assert np.multiply(found, MEAN) == pytest.approx(color)
    else:
        assert max(found) == pytest.approx(1)
