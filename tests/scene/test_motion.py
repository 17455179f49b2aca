"""Cameras of films, sheets and two eyes: all see the whole scene."""

from __future__ import annotations

import json
from typing import get_args

import numpy as np
import pytest

from app.arrays import Floats
from app.output.projection import Projection
from app.program.reading import read_program
from app.scene.eyes import eyes, suitable
from app.scene.framing import vertices_of
from app.scene.motion import Motion, cameras_of
from app.scene.scene import Camera, Scene
from app.scene.viewpoints import viewpoints
from app.settings import Settings
from app.staging import make_scene
from tests.service import SMALL

ASPECT = 4 / 3


def scene(projection: str = "perspective") -> Scene:
    document = {**SMALL, "view": {"projection": projection}}
    return make_scene(read_program(json.dumps(document).encode(), Settings()), ASPECT)


def places(seen: Scene, camera: Camera) -> Floats:
    """Where all vertices are in a picture of width 4 and height 3, and how far away."""
    return Projection.of(camera, 4, 3)(vertices_of(seen))


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_a_turntable_and_a_sheet_always_see_everything(projection: str) -> None:
    seen = scene(projection)
    cameras = [*cameras_of(seen, "turntable", 12), *(camera for _, camera in viewpoints(seen))]
    for camera in cameras:
        x, y, depth = places(seen, camera).T
        assert x.min() >= 0
        assert x.max() <= 4
        assert y.min() >= 0
        assert y.max() <= 3
        assert depth.min() > 0


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("motion", get_args(Motion))
def test_films_move_smoothly_and_end_where_they_begin(motion: Motion, projection: str) -> None:
    cameras = cameras_of(scene(projection), motion, 60)
    assert len(cameras) == 60
    positions = np.array([camera.position for camera in cameras])
    steps = np.linalg.norm(np.diff(np.vstack([positions, positions[:1]]), axis=0), axis=1)
    assert steps.max() < 0.2 * np.linalg.norm(np.ptp(positions, axis=0))


def test_a_flight_never_enters_the_scene() -> None:
    seen = scene()
    for camera in cameras_of(seen, "flight", 60):
        assert places(seen, camera)[:, 2].min() > 0
        assert camera.near > 0


def test_eyes_are_as_far_apart_as_was_asked_and_look_in_parallel() -> None:
    seen = scene()
    left, right = eyes(seen.camera, seen.bounds, 0.05)
    apart = np.subtract(right.position, left.position)
    away = np.linalg.norm(np.subtract(seen.camera.position, seen.camera.target))
    assert np.linalg.norm(apart) == pytest.approx(0.05 * away)
    assert np.subtract(right.target, left.target) == pytest.approx(apart)
    assert left.shift[0] == -right.shift[0] > 0


def test_eyes_suit_the_depth_of_the_scene() -> None:
    seen = scene()
    assert 0 < suitable(seen.camera, seen.bounds) <= 1 / 15
    deep = seen.bounds + np.array([[0, 0, 0], [0, 300, 0]])
    assert suitable(seen.camera, deep) < suitable(seen.camera, seen.bounds)
