from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.weaving.courses import AROUND, FLAT, ROOM, SOFT, End, lay_course
from app.hyperedges.weaving.curvature import least_radius

PLANE = 3.0
RADIUS = 0.15
UP = np.array([0.0, 0.0, 1.0])


def foot(x: float, y: float) -> End:
    return End(True, np.array([x, y, 0.5]), UP, np.array([x, y], dtype=np.float64), 0.5)


def join(x: float, y: float, angle: float) -> End:
    direction = np.array([np.cos(angle), np.sin(angle), 0.0])
    return End(False, np.array([x, y, PLANE]), direction, np.array([x, y], dtype=np.float64), PLANE)


def way_between(start: End, end: End, *corners: tuple[float, float]) -> Floats:
    """Corners from node to node; joins are left along their direction for two radii."""
    way = [start.foot, *corners, end.foot]
    if not start.is_attachment:
        way.insert(1, start.foot + 2 * RADIUS * start.direction[:2])
    if not end.is_attachment:
        way.insert(-1, end.foot + 2 * RADIUS * end.direction[:2])
    return np.array(way)


def lay(
    start: End, end: End, strictness: int, *corners: tuple[float, float]
) -> tuple[Floats, float]:
    cubics = np.empty((ROOM, 4, 3))
    way = way_between(start, end, *corners)
    count, least = lay_course(start, end, way, PLANE, RADIUS, strictness, cubics)
    return cubics[:count], least


def unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


def assert_sound(pieces: Floats, start: End, end: End) -> None:
    np.testing.assert_array_equal(pieces[0, 0], start.place)
    np.testing.assert_array_equal(pieces[-1, 3], end.place)
    np.testing.assert_allclose(unit(pieces[0, 1] - pieces[0, 0]), start.direction, atol=1e-9)
    np.testing.assert_allclose(unit(pieces[-1, 2] - pieces[-1, 3]), end.direction, atol=1e-9)
    np.testing.assert_array_equal(pieces[1:, 0], pieces[:-1, 3])
    for before, after in pairwise(pieces):
        np.testing.assert_allclose(
            unit(before[3] - before[2]), unit(after[1] - after[0]), atol=1e-9
        )


angles = st.floats(-1.2, 1.2)
strictnesses = st.integers(SOFT, AROUND)


@given(strictnesses, st.floats(1.5, 9.0), st.floats(-np.pi, np.pi))
def test_courses_between_attachments_are_smooth(level: int, span: float, heading: float) -> None:
    start, end = foot(0, 0), foot(span * np.cos(heading), span * np.sin(heading))
    pieces, _ = lay(start, end, level)
    assert_sound(pieces, start, end)
    assert pieces[:, :, 2].max() <= PLANE / 0.75 + 1e-9


@given(strictnesses, st.floats(1.0, 9.0), angles)
def test_courses_from_attachments_to_joins_are_smooth(level: int, span: float, turn: float) -> None:
    start, end = foot(0, 0), join(span, 0, np.pi + turn)
    for one, other in ((start, end), (end, start)):
        pieces, _ = lay(one, other, level)
        assert_sound(pieces, one, other)


@given(st.integers(FLAT, AROUND), st.floats(2.0, 9.0), angles, angles)
def test_courses_between_joins_stay_in_their_plane(
    level: int, span: float, turn: float, other: float
) -> None:
    start, end = join(0, 0, turn), join(span, 0, np.pi + other)
    pieces, _ = lay(start, end, level)
    assert_sound(pieces, start, end)
    assert (pieces[:, :, 2] == PLANE).all()


def test_strict_courses_rise_straight_and_keep_to_their_way() -> None:
    pieces, least = lay(foot(0, 0), foot(6, 0), AROUND, (2, 1), (4, 1))
    assert least >= 1.5
    upright = pieces[0]
    assert (upright[:, :2] == 0).all()
    low = pieces[..., 2] < PLANE - 2 * RADIUS
    near = np.minimum(
        np.linalg.norm(pieces[..., :2], axis=2), np.linalg.norm(pieces[..., :2] - [6, 0], axis=2)
    )
    assert (near[low] <= 1e-12).all()
    assert pieces[..., 1].min() >= -1e-12
    assert pieces[..., 1].max() <= 1 + 1e-12


@pytest.mark.parametrize("level", range(SOFT, AROUND + 1))
def test_the_least_radius_is_that_of_the_tightest_piece(level: int) -> None:
    pieces, least = lay(foot(0, 0), join(4, 1, 2.5), level)
    radii = [least_radius(piece) for piece in pieces]
    assert least == pytest.approx(min(radii) / RADIUS)
    t = np.linspace(0, 1, 5001)[:, None]
    for piece, radius in zip(pieces, radii, strict=True):
        a, b, c = np.diff(piece, axis=0)
        first = (1 - t) ** 2 * a + 2 * t * (1 - t) * b + t**2 * c
        second = (1 - t) * (b - a) + t * (c - b)
        bend = np.linalg.norm(np.cross(first, second), axis=1)
        sampled = 1.5 * np.linalg.norm(first, axis=1) ** 3 / np.maximum(bend, 1e-300)
        assert radius == pytest.approx(sampled.min(), rel=0.01) or sampled.min() > 1e6
