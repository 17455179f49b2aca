"""Cameras, sampling and tiles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.output.draft_scene import Normalization
from app.output.draft_view import Frame, frame, sampling, tiling
from app.scene.scene import Camera
from tests.output.scenes import from_above, from_front

AS_IT_IS = Normalization(np.zeros(3), 1.0)
CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)


def project(shown: Frame, point: list[float]) -> np.ndarray:
    x, y, z, w = shown.projection @ shown.view @ np.array([*point, 1.0])
    return np.asarray(np.array([x, y, z]) / w)


def test_an_orthographic_camera_sees_its_height_from_bottom_to_top() -> None:
    shown = frame(from_above(4.0), AS_IT_IS, CUBE, aspect=2.0)
    np.testing.assert_allclose(project(shown, [0, 2, 0])[:2], [0, 1], atol=1e-12)
    np.testing.assert_allclose(project(shown, [4, 0, 0])[:2], [1, 0], atol=1e-12)


def test_a_perspective_camera_sees_its_target_in_the_middle() -> None:
    shown = frame(from_front(), AS_IT_IS, CUBE, aspect=4 / 3)
    np.testing.assert_allclose(project(shown, [0, 0, 0.4])[:2], [0, 0], atol=1e-12)


def test_a_perspective_camera_sees_its_angle() -> None:
    camera = Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), 1.0, 0.1, 9.0, vertical_angle=np.pi / 2)
    shown = frame(camera, AS_IT_IS, CUBE, aspect=1.0)
    assert project(shown, [0, 5, 0])[1] == pytest.approx(1.0)


@pytest.mark.parametrize("camera", [from_above(4.0), from_front()])
def test_everything_is_within_the_depth_that_is_kept(camera: Camera) -> None:
    shown = frame(camera, AS_IT_IS, CUBE, aspect=1.0)
    depths = [project(shown, list(point))[2] for point in CUBE]
    assert min(depths) > -1
    assert max(depths) < 1


def test_a_camera_that_looks_along_its_up_still_sees() -> None:
    camera = Camera((0, 0, 5), (0, 0, 0), (0, 0, 1), 1.0, 0.1, 9.0, height=4.0)
    assert np.isfinite(project(frame(camera, AS_IT_IS, CUBE, 1.0), [1, 1, 1])).all()


def test_a_camera_without_angle_and_height_is_refused() -> None:
    camera = Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), 1.0, 0.1, 9.0)
    with pytest.raises(ValueError, match="angle"):
        frame(camera, AS_IT_IS, CUBE, 1.0)


@pytest.mark.parametrize("camera", [from_above(4.0), from_front()])
def test_a_shift_moves_the_picture_and_turns_nothing(camera: Camera) -> None:
    still = frame(camera, AS_IT_IS, CUBE, aspect=4 / 3)
    moved = frame(replace(camera, shift=(0.25, -0.5)), AS_IT_IS, CUBE, aspect=4 / 3)
    for point in CUBE:
        expected = project(still, list(point)) - [0.25, -0.5, 0]
        np.testing.assert_allclose(project(moved, list(point)), expected, atol=1e-12)


@given(st.integers(1, 5000), st.integers(1, 5000), st.sampled_from([64, 1000, 4096]))
def test_tiles_cover_the_picture_without_overlap(width: int, height: int, side: int) -> None:
    tiles = tiling(width, height, side)
    corners = list(tiles.corners())
    assert max(tiles.width, tiles.height) <= side
    assert len(set(corners)) == tiles.columns * tiles.rows
    assert all(left < width and top < height for left, top in corners) or side < 5
    assert tiles.columns * tiles.width >= width
    assert tiles.rows * tiles.height >= height


def test_windows_of_a_frame_show_its_parts() -> None:
    shown = frame(from_above(4.0), AS_IT_IS, CUBE, aspect=1.0)
    upper_right = shown.window(0.5, 0.0, 1.0, 0.5)
    np.testing.assert_allclose(project(upper_right, [1, 1, 0])[:2], [0, 0], atol=1e-12)
    np.testing.assert_allclose(project(upper_right, [2, 2, 0])[:2], [1, 1], atol=1e-12)


def in_window(shown: Frame, point: list[float], size: tuple[int, int]) -> np.ndarray:
    """Pixels and depth from 0 to 1."""
    x, y, z = project(shown, point)
    return np.array([(x + 1) / 2 * size[0], (y + 1) / 2 * size[1], (z + 1) / 2])


cameras = st.sampled_from([from_above(4.0), from_front()])
places = st.tuples(*[st.floats(-1, 1)] * 3)


@given(cameras, places)
def test_the_way_back_from_the_window_ends_where_it_began(
    camera: Camera, place: tuple[float, float, float]
) -> None:
    shown, size = frame(camera, AS_IT_IS, CUBE, aspect=2.0), (200, 100)
    matrix = np.asarray(shown.numbers(size)["to_world"])
    x, y, z, w = matrix @ [*in_window(shown, list(place), size), 1.0]
    np.testing.assert_allclose(np.array([x, y, z]) / w, place, atol=1e-9)
    assert w > 0


@given(cameras, places)
def test_depths_of_the_ground_are_those_of_places_on_it(
    camera: Camera, place: tuple[float, float, float]
) -> None:
    shown, size = frame(camera, AS_IT_IS, CUBE, aspect=2.0), (200, 100)
    *plane, is_seen = shown.ground_depths(place[2], size)
    x, y, depth = in_window(shown, list(place), size)
    assert is_seen == 1.0
    assert np.dot(plane, [x, y, 1.0]) == pytest.approx(depth, abs=1e-9)


def test_the_ground_is_not_seen_from_below() -> None:
    shown = frame(from_above(4.0), AS_IT_IS, CUBE, aspect=1.0)
    camera = Camera((0, 0, -5), (0, 0, 0), (0, 1, 0), 1.0, 0.1, 9.0, height=4.0)
    below = frame(camera, AS_IT_IS, CUBE, aspect=1.0)
    assert shown.ground_depths(-1.0, (8, 8))[3] == 1.0
    assert below.ground_depths(-1.0, (8, 8))[3] == 0.0


@given(cameras, places)
def test_distances_are_along_the_axis_of_the_camera(
    camera: Camera, place: tuple[float, float, float]
) -> None:
    shown = frame(camera, AS_IT_IS, CUBE, aspect=2.0)
    depth = np.array([in_window(shown, list(place), (2, 2))[2], 1.0], dtype=np.float32)
    axis = np.subtract(camera.target, camera.position)
    away = np.subtract(place, camera.position) @ axis / np.linalg.norm(axis)
    found = shown.distances(depth)
    assert found[0] == pytest.approx(away, rel=1e-4)
    assert np.isinf(found[1])


def test_tiles_are_put_together_as_they_were_cut() -> None:
    picture = np.arange(7 * 11 * 2).reshape(7, 11, 2)
    cut = tiling(11, 7, 4)
    padded = np.pad(picture, ((0, 4), (0, 4), (0, 0)))
    tiles = [padded[y : y + cut.height, x : x + cut.width] for x, y in cut.corners()]
    np.testing.assert_array_equal(cut.joined(tiles), picture)


def test_all_but_the_largest_pictures_have_several_samples_in_a_pixel() -> None:
    assert sampling(1024, 768) == sampling(3840, 2160) == 4
    assert sampling(4096, 4096) == 1
