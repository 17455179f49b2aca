from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.program.model import View
from app.scene.camera import frame
from app.scene.eyes import DEVIATION, WIDEST, eyes, suitable
from app.scene.scene import Camera
from tests.scene.hand_built import axes_of, seen_by

BOUNDS = np.array([[-2.0, -1.5, 0.0], [2.0, 1.5, 1.2]])
CORNERS = np.array(np.meshgrid(*BOUNDS.T)).reshape(3, 8).T


def looking_at(corners: Floats, aspect: float = 4 / 3, **wishes: Any) -> Camera:
    view = View.model_validate(wishes)
    return frame(lambda direction: corners[int((corners @ direction).argmax())], view, aspect)


def seen(camera: Camera, points: Floats) -> Floats:
    """Where points are in a picture that is shifted, (n, 2)."""
    return np.asarray(seen_by(camera, points)[:, :2] - camera.shift)


def parallax(camera: Camera, distance: float | None, points: Floats = CORNERS) -> Floats:
    left, right = eyes(camera, BOUNDS, distance)
    return np.asarray(seen(right, points) - seen(left, points))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_what_the_camera_looks_at_lies_in_the_plane_of_the_picture(projection: str) -> None:
    camera = looking_at(CORNERS, projection=projection)
    axes = axes_of(camera)
    plane = np.array([camera.target, camera.target + axes.up, camera.target + axes.right])
    assert parallax(camera, 0.05, plane) == pytest.approx(np.zeros((3, 2)), abs=2e-3)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_what_is_near_lies_farther_left_for_the_right_eye(projection: str) -> None:
    camera = looking_at(CORNERS, projection=projection)
    apart = parallax(camera, 0.05)[:, 0]
    depth = seen_by(camera, CORNERS)[:, 2]
    assert apart[depth.argmin()] < 0 < apart[depth.argmax()]
    nearest_first = apart[np.argsort(depth)]
    assert (np.diff(nearest_first) > -1e-9).all()


@given(
    st.sampled_from(["perspective", "orthographic"]),
    st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.1, 1)),
    st.floats(5, 100),
    st.floats(0, 0.2),
)
def test_nothing_lies_higher_for_one_eye_than_for_the_other(
    projection: str, direction: tuple[float, float, float], angle: float, distance: float
) -> None:
    camera = looking_at(CORNERS, projection=projection, from_=direction, field_of_view=angle)
    assert parallax(camera, distance)[:, 1] == pytest.approx(np.zeros(8), abs=1e-9)


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_a_deep_scene_comes_apart_by_a_thirtieth_of_the_picture(projection: str) -> None:
    deep = BOUNDS * [1, 10, 1]
    corners = np.array(np.meshgrid(*deep.T)).reshape(3, 8).T
    camera = looking_at(corners, projection=projection, from_=(0.0, -1.0, 0.0))
    assert suitable(camera, deep) < WIDEST
    left, right = eyes(camera, deep, None)
    apart = seen(right, corners)[:, 0] - seen(left, corners)[:, 0]
    # Both sides of the picture are two halves of its width apart.
    assert np.ptp(apart) == pytest.approx(2 * DEVIATION, rel=0.02)


def test_a_flat_scene_does_not_part_the_eyes_for_ever() -> None:
    flat = np.array([[-1.0, 0, -1], [1, 0, 1]])
    camera = looking_at(CORNERS, from_=(0.0, -1.0, 0.0))
    assert suitable(camera, flat) == WIDEST
    assert suitable(camera, np.zeros((2, 3))) == WIDEST


def test_eyes_are_as_far_apart_as_wished_and_look_in_parallel() -> None:
    camera = looking_at(CORNERS)
    left, right = eyes(camera, BOUNDS, 0.1)
    apart = np.subtract(right.position, left.position)
    away = np.linalg.norm(np.subtract(camera.position, camera.target))
    assert np.linalg.norm(apart) == pytest.approx(0.1 * away)
    assert apart @ axes_of(camera).right == pytest.approx(0.1 * away)
    assert axes_of(left).back == pytest.approx(axes_of(right).back)
    assert left.shift == pytest.approx((-right.shift[0], 0.0))


def test_no_distance_is_the_same_picture_twice() -> None:
    camera = looking_at(CORNERS)
    left, right = eyes(camera, BOUNDS, 0.0)
    assert left.position == pytest.approx(right.position)
    assert left.shift == pytest.approx((0.0, 0.0))


@pytest.mark.parametrize("aspect", [0.5, 4 / 3, 3])
@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_with_the_usual_margin_nothing_is_cut_off(projection: str, aspect: float) -> None:
    camera = looking_at(CORNERS, aspect, projection=projection)
    for eye in eyes(camera, BOUNDS, None):
        assert np.abs(seen(eye, CORNERS)).max() < 1
        depth = seen_by(eye, CORNERS)[:, 2]
        assert eye.near < depth.min()
        assert depth.max() < eye.far
