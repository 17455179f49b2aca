from __future__ import annotations

import numpy as np
import pytest

from app.scene.color import difference, srgb_of
from app.scene.ground import WIDTH, disc_below, ground_color


def test_the_ground_lies_under_the_middle_of_the_scene_and_reaches_beyond() -> None:
    disc, center = disc_below(np.array([[0.0, 0, -1], [4, 2, 3]]))
    assert center == pytest.approx([2, 1, -1])
    assert np.abs(disc.bounds[:, :2]).min() == pytest.approx(WIDTH * 3, rel=1e-6)
    assert not disc.vertices[:, 2].any()


def test_the_ground_faces_up() -> None:
    disc, _ = disc_below(np.array([[0.0, 0, 0], [1, 1, 1]]))
    corners = disc.vertices[disc.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (across[:, 2] > 0).all()
    assert (disc.normals == [0, 0, 1]).all()


@pytest.mark.parametrize("background", ["#ffffff", "#111827", "#f3f0e8", "#3b82f6"])
def test_the_ground_looks_nearly_like_the_background(background: str) -> None:
    color = srgb_of(ground_color(srgb_of(background)))
    assert 0.02 < float(difference(color, srgb_of(background))) < 0.08


def test_on_black_the_ground_is_light_enough_to_be_seen() -> None:
    assert ground_color(srgb_of("#000000")) == "#0d0d0d"


def test_on_a_transparent_background_the_ground_is_light_grey() -> None:
    assert ground_color(None) == "#ededed"
