"""Frames: right-handed, known from the tangent alone, and carried along without turning."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.arrays import Floats
from app.tubes.frames import basis, carry, turn
from app.tubes.track import TRACK_ROWS

angles = st.floats(-np.pi, np.pi)


def track_of(points: Floats, tangents: Floats, first: Floats) -> Floats:
    """A track through ``points`` that carries the direction ``first``."""
    track = np.zeros((TRACK_ROWS, len(points)))
    track[0:3], track[3:6] = points.T, tangents.T
    frame = np.array(basis(*tangents[0])).reshape(2, 3)
    track[12:, 0] = frame @ first
    carry(track, len(points))
    return track


def carried(track: Floats) -> Floats:
    """The directions that a track carries, (m, 3)."""
    return np.asarray((track[6:9] * track[12] + track[9:12] * track[13]).T)


def double_reflection(points: Floats, tangents: Floats, first: Floats) -> Floats:
    """Table I of Wang, Jüttler, Zheng and Liu, word for word."""
    directions = [first]
    for i in range(len(points) - 1):
        v1 = points[i + 1] - points[i]
        c1 = v1 @ v1
        reflected = directions[i] - (2 / c1) * (v1 @ directions[i]) * v1
        tangent = tangents[i] - (2 / c1) * (v1 @ tangents[i]) * v1
        v2 = tangents[i + 1] - tangent
        c2 = v2 @ v2
        directions.append(reflected - (2 / c2) * (v2 @ reflected) * v2)
    return np.array(directions)


def helix(count: int) -> tuple[Floats, Floats]:
    t = np.linspace(0, 2 * np.pi, count)
    points = np.stack([np.cos(t), np.sin(t), 0.5 * t], axis=1)
    tangents = np.stack([-np.sin(t), np.cos(t), np.full_like(t, 0.5)], axis=1)
    return points, tangents / np.sqrt(1.25)


@given(angles, angles)
def test_a_tangent_alone_gives_a_right_handed_frame(turn_about_z: float, height: float) -> None:
    tangent = np.array(
        [
            np.cos(height) * np.cos(turn_about_z),
            np.cos(height) * np.sin(turn_about_z),
            np.sin(height),
        ]
    )
    frame = np.array([*basis(*tangent), *tangent]).reshape(3, 3)
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame) == pytest.approx(1.0)


@pytest.mark.parametrize("z", [1.0, -1.0])
def test_the_poles_are_no_exception(z: float) -> None:
    frame = np.array([*basis(0.0, 0.0, z), 0.0, 0.0, z]).reshape(3, 3)
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=0)


def test_carrying_is_the_double_reflection_of_the_paper() -> None:
    points, tangents = helix(20)
    first = np.array([1.0, 0.0, 0.0])
    directions = carried(track_of(points, tangents, first))
    np.testing.assert_allclose(directions, double_reflection(points, tangents, first), atol=1e-12)


def test_along_a_helix_the_frame_turns_by_its_torsion() -> None:
    # Against the normal towards the axis, a rotation-minimising frame turns by torsion times
    # length: 0.5 / 1.25 along 2 pi sqrt(1.25).
    points, tangents = helix(400)
    directions = carried(track_of(points, tangents, np.array([1.0, 0.0, 0.0])))
    expected = 2 * np.pi * np.sqrt(1.25) * 0.5 / 1.25
    assert directions[-1, 0] == pytest.approx(np.cos(expected), abs=1e-6)


def test_in_a_plane_the_normal_of_the_plane_stays() -> None:
    t = np.linspace(0, 1.7 * np.pi, 50)
    points = np.stack([np.cos(t), np.sin(t), np.zeros_like(t)], axis=1)
    tangents = np.stack([-np.sin(t), np.cos(t), np.zeros_like(t)], axis=1)
    directions = carried(track_of(points, tangents, np.array([0.0, 0.0, 1.0])))
    np.testing.assert_allclose(directions, np.tile([0.0, 0.0, 1.0], (50, 1)), atol=1e-12)


def test_where_places_coincide_the_direction_follows_the_shortest_turn() -> None:
    points = np.zeros((3, 3))
    tangents = np.array([[1.0, 0, 0], [0, 1, 0], [0, -1, 0]])
    directions = carried(track_of(points, tangents, np.array([0.0, 0.0, 1.0])))
    np.testing.assert_allclose(np.abs(directions), np.tile([0.0, 0.0, 1.0], (3, 1)), atol=1e-12)
    directions = carried(track_of(points[:2], tangents[:2], np.array([0.0, 1.0, 0.0])))
    np.testing.assert_allclose(directions[1], [-1.0, 0.0, 0.0], atol=1e-12)


def test_frames_turn_to_the_carried_direction_and_on_by_the_twist() -> None:
    points, tangents = helix(30)
    track = track_of(points, tangents, np.array([1.0, 0.0, 0.0]))
    directions = carried(track)
    turn(track, 30, 0.01)
    ahead = np.arange(30) * 0.01
    np.testing.assert_allclose(
        np.einsum("xm,mx->m", track[6:9], directions), np.cos(ahead), atol=1e-12
    )
    np.testing.assert_allclose(
        np.einsum("xm,mx->m", track[9:12], directions), -np.sin(ahead), atol=1e-12
    )
    np.testing.assert_allclose(np.cross(track[6:9], track[9:12], axis=0), tangents.T, atol=1e-12)
