from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.scene.camera import axes_from
from app.scene.lights import LOWEST, three_point
from app.scene.scene import Light

numbers = st.floats(-1, 1).map(lambda number: round(number, 3))
directions = st.tuples(numbers, numbers, numbers)
USUAL = (0.0, -1.0, 0.8)


def toward(light: Light) -> Floats:
    return -np.array(light.direction)


def brightness(lights: tuple[Light, ...], normals: Floats) -> Floats:
    """Of white, matte surfaces with these normals: 1 is white."""
    return (
        sum(
            (
                np.clip(normals @ toward(light), 0, None) * light.illuminance * np.mean(light.color)
                for light in lights
            ),
            start=np.zeros(len(normals)),
        )
        / np.pi
    )


@given(directions)
def test_lights_are_unit_directions_and_only_the_key_casts_shadows(
    direction: tuple[float, float, float],
) -> None:
    lights = three_point(axes_from(direction))
    assert [light.casts_shadows for light in lights] == [True, False, False]
    assert np.linalg.norm([light.direction for light in lights], axis=1) == pytest.approx(1)


@given(directions)
def test_key_and_rim_never_shine_from_below(direction: tuple[float, float, float]) -> None:
    for light in three_point(axes_from(direction)):
        if light.name != "fill":
            x, y, z = toward(light)
            assert z >= LOWEST * np.hypot(x, y) - 1e-12


def test_the_key_comes_from_the_upper_left_and_the_rim_from_behind() -> None:
    axes = axes_from(USUAL)
    key, fill, rim = map(toward, three_point(axes))
    assert key @ axes.right < 0 < key @ axes.up
    assert fill @ axes.right > 0
    assert rim @ axes.back < 0


def test_what_faces_the_camera_is_bright_and_nothing_is_blown_out() -> None:
    axes = axes_from(USUAL)
    lights = three_point(axes)
    spread = np.random.default_rng(1).normal(size=(2000, 3))
    spread /= np.linalg.norm(spread, axis=1, keepdims=True)
    assert 0.65 < brightness(lights, axes.back[None])[0] < 0.9
    assert 0.85 < brightness(lights, spread).max() <= 1.0


def test_what_faces_the_camera_on_the_right_is_not_black() -> None:
    axes = axes_from(USUAL)
    aside = (axes.right + axes.back)[None] / np.sqrt(2)
    assert brightness(three_point(axes), aside)[0] > 0.3


def test_before_what_is_upright_the_key_shines_along_the_eyes() -> None:
    """So what stands out of the front throws its shadow behind itself, and not down the front."""
    axes = axes_from((0.12, -1.0, 0.2))
    usual, upright = (three_point(axes, is_upright=flag)[0] for flag in (False, True))
    assert upright.casts_shadows
    assert toward(upright) @ axes.back > 0.9 > toward(usual) @ axes.back
