from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.program.model import Program, View
from app.scene.camera import SHORTEST, VIEWS, Farthest, axes_from, axes_of, frame, view_of
from app.scene.scene import Camera
from tests.scene.hand_built import seen_by

Projection = Literal["perspective", "orthographic"]
PROJECTIONS: tuple[Projection, ...] = ("perspective", "orthographic")

numbers = st.floats(-1, 1).map(lambda number: round(number, 3))
directions = st.tuples(numbers, numbers, numbers)
places = st.tuples(*[st.floats(-100, 100)] * 3)
sizes = st.tuples(*[st.floats(0.05, 20)] * 3)
views = st.builds(
    View,
    projection=st.sampled_from(PROJECTIONS),
    from_=directions,
    field_of_view=st.floats(1, 90),
    margin=st.floats(0, 0.45),
)


def of_points(points: Floats) -> Farthest:
    return lambda direction: points[int((points @ direction).argmax())]


def corners(center: tuple[float, ...], size: tuple[float, ...]) -> Floats:
    half = np.array(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [-0.5, 0.5])).reshape(3, 8).T
    return half * size + center


def look(points: Floats, aspect: float = 4 / 3, **wishes: object) -> Camera:
    return frame(of_points(points), View.model_validate(wishes), aspect)


@given(st.lists(st.tuples(places, sizes), min_size=1, max_size=5), views, st.floats(0.2, 5))
def test_everything_lies_within_the_margin_and_touches_it_on_both_sides(
    boxes: list[tuple[tuple[float, ...], tuple[float, ...]]], view: View, aspect: float
) -> None:
    points = np.concatenate([corners(center, size) for center, size in boxes])
    camera = frame(of_points(points), view, aspect)
    seen = seen_by(camera, points)
    inside = 1 - 2 * view.margin
    assert (np.abs(seen[:, :2]) <= inside + 1e-6).all()

    left, bottom = seen[:, :2].min(axis=0)
    right, top = seen[:, :2].max(axis=0)
    assert left == pytest.approx(-right, abs=1e-6), "centred from left to right"
    assert bottom == pytest.approx(-top, abs=1e-6), "centred from bottom to top"
    held_off = camera.vertical_angle is not None and _is_nearest_allowed(camera, points)
    assert max(right, top) == pytest.approx(inside, abs=1e-6) or held_off


def _is_nearest_allowed(camera: Camera, points: Floats) -> bool:
    """Whether the camera would have to be inside of what it sees."""
    depth = seen_by(camera, points)[:, 2]
    return bool(depth.min() < 0.02 * np.ptp(points, axis=0).max() * np.sqrt(3))


@given(st.lists(places, min_size=2, max_size=9), views)
def test_near_and_far_enclose_the_scene_closely(
    points: list[tuple[float, float, float]], view: View
) -> None:
    spread = np.array(points)
    camera = frame(of_points(spread), view, 1.5)
    depth = seen_by(camera, spread)[:, 2]
    assert 0 < camera.near < camera.far
    if np.ptp(spread, axis=0).max() > 1e-3:
        assert camera.near <= depth.min() <= camera.near * 1.2
        assert camera.far * 0.9 <= depth.max() <= camera.far


@pytest.mark.parametrize("projection", PROJECTIONS)
@pytest.mark.parametrize(
    ("direction", "up", "right"),
    [
        ((0, 0, 1), (0, 1, 0), (1, 0, 0)),
        ((0, 0, -1), (0, 1, 0), (-1, 0, 0)),
        ((0, -1, 0), (0, 0, 1), (1, 0, 0)),
        ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
        ((0, 0, 1e6), (0, 1, 0), (1, 0, 0)),
    ],
)
def test_up_is_z_and_seen_from_above_or_below_y(
    projection: Projection,
    direction: tuple[float, float, float],
    up: tuple[float, float, float],
    right: tuple[float, float, float],
) -> None:
    view = View(projection=projection, from_=direction)
    camera = frame(of_points(corners((3, 4, 5), (1, 2, 3))), view, 4 / 3)
    assert camera.up == pytest.approx(up, abs=1e-12)
    at_right = seen_by(camera, np.array([camera.target]) + right)
    assert at_right[0, 0] > 0
    assert at_right[0, 1] == pytest.approx(0, abs=1e-9)


def test_a_direction_almost_straight_down_still_has_z_up() -> None:
    axes = axes_from((0.0, -1e-5, 1.0))
    assert axes.right == pytest.approx([1, 0, 0])
    assert axes.up[2] > 0


def test_no_direction_is_the_usual_one() -> None:
    assert axes_from((0.0, 0.0, 0.0)).back == pytest.approx(axes_of(View()).back)


@pytest.mark.parametrize("projection", PROJECTIONS)
def test_nothing_and_a_point_are_framed_like_a_ball_of_one_unit(projection: Projection) -> None:
    view = View(projection=projection, margin=0)
    nothing = frame(None, view, 2.0)
    point = frame(of_points(np.array([[7.0, 8.0, 9.0]])), view, 2.0)
    assert point.target == pytest.approx((7, 8, 9))
    assert nothing.target == pytest.approx((0, 0, 0))
    assert point.far == pytest.approx(nothing.far)
    edge = seen_by(nothing, 0.5 * np.array([nothing.up]))
    assert 0.9 < edge[0, 1] <= 1.0


@pytest.mark.parametrize("projection", PROJECTIONS)
def test_a_line_towards_the_camera_is_seen(projection: Projection) -> None:
    line = np.array([[0.0, 0, 0], [0, -10, 8]])
    camera = look(line, projection=projection)
    seen = seen_by(camera, line)
    assert np.isfinite(seen).all()
    assert (seen[:, 2] > camera.near * 0.99).all()


def test_an_orthographic_camera_sees_its_height() -> None:
    camera = look(
        corners((0, 0, 0), (4, 1, 2)),
        aspect=1.0,
        projection="orthographic",
        margin=0.1,
        **{"from": (0, -1, 0)},
    )
    assert camera.vertical_angle is None
    assert camera.height == pytest.approx(4 / 0.8)


def test_a_wide_angle_comes_nearer_and_a_margin_farther() -> None:
    box = corners((0, 0, 0), (1, 1, 1))

    def distance(**wishes: float) -> float:
        return float(np.linalg.norm(look(box, **wishes).position))

    assert distance(field_of_view=60) < distance(field_of_view=30) < distance(margin=0.2)


def test_the_ground_is_within_depth_but_not_framed() -> None:
    box = of_points(corners((0, 0, 0.5), (1, 1, 1)))
    ground = of_points(corners((0, 0, 0), (50, 50, 0)))
    without, with_ground = frame(box, View(), 1.0), frame(box, View(), 1.0, ground)
    assert with_ground.position == without.position
    assert with_ground.far > without.far
    nearest = float(np.linalg.norm(np.array(without.position))) - 1
    assert SHORTEST * nearest / 2 < with_ground.near < without.near


def test_far_from_the_origin_the_picture_is_the_same() -> None:
    near_home = look(corners((0, 0, 0), (1, 2, 3)))
    far_away = look(corners((1e6, -1e6, 1e6), (1, 2, 3)))
    moved = np.subtract(far_away.position, (1e6, -1e6, 1e6))
    assert moved == pytest.approx(near_home.position, abs=1e-7)


def test_layers_are_seen_from_before_unless_the_program_says_from_where() -> None:
    layers = {"items": [], "layout": {"placement": "layers"}}
    usual, own = (
        view_of(Program.model_validate(layers | more), "layers")
        for more in ({}, {"view": {"from": (1.0, -1.0, 1.0)}})
    )
    assert (usual.projection, usual.from_) == ("orthographic", VIEWS["layers"])
    assert (own.projection, own.from_) == ("perspective", (1.0, -1.0, 1.0))
