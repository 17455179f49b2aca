"""Exposure and shadow cameras."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.output.draft_light import MOST_LIGHTS, lighting, shadow_camera
from app.scene.scene import Light
from tests.output.scenes import WHITE, sun

directions = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)


@given(st.lists(st.tuples(directions, st.floats(0.01, 1e5)), min_size=1, max_size=5))
def test_white_paper_is_never_brighter_than_white_and_somewhere_is(
    suns: list[tuple[tuple[float, float, float], float]],
) -> None:
    light = lighting([Light("a sun", way, WHITE, lux, False) for way, lux in suns])
    random = np.random.default_rng(1)
    normals = random.normal(size=(2000, 3))
    falling = light.at(normals / np.linalg.norm(normals, axis=1, keepdims=True)).max(axis=1)
    assert 0.97 < falling.max() < 1.01


def test_the_sun_that_casts_shadows_comes_first() -> None:
    bright = Light("bright", (0.0, 0.0, -1.0), WHITE, 10.0, casts_shadows=False)
    light = lighting([bright, sun((1.0, 0.0, -1.0))])
    assert light.sun is not None
    np.testing.assert_allclose(light.sun, np.array([-1.0, 0.0, 1.0]) / np.sqrt(2))


def test_without_a_sun_that_casts_shadows_there_are_none() -> None:
    assert lighting([Light("fill", (0.0, 0.0, -1.0), WHITE, 1.0, False)]).sun is None
    assert lighting([]).sun is None


def test_of_too_many_lights_the_brightest_shine() -> None:
    suns = [Light(str(k), (0.0, 0.0, -1.0), WHITE, float(k), False) for k in range(20)]
    assert len(lighting(suns).toward) == MOST_LIGHTS


@given(
    toward=directions,
    seed=st.integers(0, 1000),
    margin=st.floats(0, 1),
)
def test_a_shadow_map_holds_its_casters_and_fits_them(
    toward: tuple[float, float, float], seed: int, margin: float
) -> None:
    points = np.random.default_rng(seed).uniform(-1, 1, (50, 3)).astype(np.float32)
    camera = shadow_camera(np.array(toward), points, edge=0.01, margin=margin)
    mapped = points @ camera.matrix[:3, :3].T + camera.matrix[:3, 3]
    share = margin / camera.extent[:2]
    for axis in range(2):
        low, high = mapped[:, axis].min(), mapped[:, axis].max()
        assert low == pytest.approx(0.01 + share[axis], abs=1e-4)
        assert high == pytest.approx(0.99 - share[axis], abs=1e-4)
    assert mapped[:, 2].min() > 0
    assert mapped[:, 2].max() < 1


def test_depth_in_a_shadow_map_grows_away_from_the_light() -> None:
    points = np.array([[0, 0, 0], [0, 0, 1], [1, 1, 0.5]], dtype=np.float32)
    camera = shadow_camera(np.array([0.0, 0.0, 1.0]), points, edge=0.0)
    low, high = (camera.matrix @ [*points[index], 1.0] for index in (0, 1))
    assert high[2] < low[2]


def test_the_ground_gets_what_a_level_sheet_gets() -> None:
    light = lighting([sun((0.3, 0.0, -1.0)), Light("fill", (1.0, 0.0, -0.2), WHITE, 1.0, False)])
    falling = light.at(np.array([[0.0, 0.0, 1.0]]))[0]
    assert light.on_the_ground == pytest.approx(falling @ [0.2126, 0.7152, 0.0722])
