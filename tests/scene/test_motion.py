from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.scene.camera import axes_from
from app.scene.flight import flight
from app.scene.framing import vertices_of
from app.scene.motion import axis_of, cameras_of
from app.scene.scene import Camera, Scene
from tests.scene.hand_built import axes_of, program_of, scene_of, seen_by, three_items

VIEWS = st.fixed_dictionaries(
    {
        "projection": st.sampled_from(["perspective", "orthographic"]),
        "from": st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(any)
        | st.sampled_from([(0, 0, 1), (0, 0, -1), (1, 0, 0)]),
        "field_of_view": st.floats(1, 120),
        "margin": st.floats(0, 0.3),
    }
)


def scene_seen(aspect: float = 4 / 3, **view: Any) -> Scene:
    return scene_of(three_items(view=view), aspect=aspect)


def headings(cameras: tuple[Camera, ...]) -> list[float]:
    """Where from the cameras look, in turns from the first."""
    backs = np.array([np.subtract(camera.position, camera.target) for camera in cameras])
    angles = np.unwrap(np.arctan2(backs[:, 1], backs[:, 0]))
    turns: list[float] = ((angles - angles[0]) / (2 * np.pi)).tolist()
    return turns


@settings(max_examples=40)
@given(VIEWS, st.floats(0.4, 3))
def test_a_turntable_never_cuts_anything_off(view: dict[str, Any], aspect: float) -> None:
    scene = scene_seen(aspect, **view)
    vertices = vertices_of(scene)
    for camera in cameras_of(scene, "turntable", 5):
        seen = seen_by(camera, vertices)
        assert np.abs(seen[:, :2]).max() < 1 + 1e-6
        assert camera.near < seen[:, 2].min()
        assert seen[:, 2].max() < camera.far


def test_a_turntable_goes_round_once_at_one_height_and_distance() -> None:
    scene = scene_seen()
    cameras = cameras_of(scene, "turntable", 36)
    assert headings(cameras) == pytest.approx((np.arange(36) / 36).tolist())
    away = np.array([camera.position for camera in cameras]) - axis_of(scene)
    assert np.hypot(away[:, 0], away[:, 1]) == pytest.approx(np.full(36, np.hypot(*away[0, :2])))
    assert away[:, 2] == pytest.approx(np.full(36, away[0, 2]))


def test_a_turntable_begins_where_the_document_looks_from_and_keeps_its_lens() -> None:
    scene = scene_seen(field_of_view=50)
    first = cameras_of(scene, "turntable", 8)[0]
    assert axes_of(first).back == pytest.approx(axes_of(scene.camera).back)
    assert first.vertical_angle == pytest.approx(scene.camera.vertical_angle)


def test_a_turntable_keeps_the_margin_and_no_more() -> None:
    scene = scene_seen(margin=0.1)
    cameras = cameras_of(scene, "turntable", 90)
    widest = max(np.abs(seen_by(camera, vertices_of(scene))[:, :2]).max() for camera in cameras)
    assert widest == pytest.approx(0.8, abs=0.01)


@pytest.mark.parametrize("motion", ["turntable", "flight"])
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_an_empty_scene_moves_too(motion: str, projection: str) -> None:
    scene = scene_of(program_of(items=[], view={"projection": projection}))
    for camera in cameras_of(scene, "flight" if motion == "flight" else "turntable", 4):
        assert np.isfinite([*camera.position, *camera.up, camera.near, camera.far]).all()
        assert 0 < camera.near < camera.far


@settings(max_examples=40)
@given(VIEWS)
def test_a_flight_never_enters_the_scene_nor_cuts_off_what_is_near(view: dict[str, Any]) -> None:
    scene = scene_seen(**view)
    low, high = scene.bounds
    vertices = vertices_of(scene)
    for camera in flight(scene, 24):
        outside = np.maximum(low - camera.position, camera.position - high).max()
        assert outside > 0
        seen = seen_by(camera, vertices)
        shown = (np.abs(seen[:, :2]) <= 1).all(axis=1) & (seen[:, 2] > 0)
        assert camera.near < seen[shown, 2].min(initial=np.inf)
        assert camera.far > seen[:, 2].max()


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("direction", [(0.2, -1, 1), (0, 0, 1), (0, 0, -1), (1, 0.5, -0.7)])
def test_a_flight_begins_as_the_document_looks(
    projection: str, direction: tuple[float, float, float]
) -> None:
    scene = scene_seen(projection=projection, from_=direction)
    first = flight(scene, 12)[0]
    assert axes_of(first).back == pytest.approx(axes_of(scene.camera).back, abs=1e-9)
    assert first.up == pytest.approx(scene.camera.up, abs=1e-9)
    vertices = vertices_of(scene)
    assert seen_by(first, vertices)[:, :2] == pytest.approx(
        seen_by(scene.camera, vertices)[:, :2], abs=1e-9
    )


def test_a_flight_is_smooth_and_rests_where_it_begins_and_ends() -> None:
    scene = scene_seen()
    cameras = flight(scene, 600)
    places = np.array([camera.position for camera in (*cameras, cameras[0])])
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert max(steps[0], steps[-1]) < 0.001 * steps.max()
    bends = np.linalg.norm(np.diff(places, n=2, axis=0), axis=1)
    assert bends.max() < 0.05 * steps.max()


def test_a_flight_sees_the_scene_from_above_and_from_low_and_near() -> None:
    scene = scene_seen()
    backs = [axes_of(camera).back for camera in flight(scene, 48)]
    heights = np.degrees(np.arcsin([back[2] for back in backs]))
    usual = np.degrees(np.arcsin(axes_from((0.2, -1, 1)).back[2]))
    assert heights.max() > usual + 10
    assert heights.min() < 16
    away = [np.linalg.norm(np.subtract(c.position, axis_of(scene))) for c in flight(scene, 48)]
    assert min(away) < 0.6 * away[0]
