from __future__ import annotations

import numpy as np
import pytest

from app.scene.framing import vertices_of, view_of
from app.scene.viewpoints import viewpoints
from tests.scene.hand_built import axes_of, program_of, scene_of, seen_by, three_items


def test_there_are_six_views_and_the_first_is_the_documents_own() -> None:
    scene = scene_of(three_items())
    views = viewpoints(scene)
    assert [name for name, _ in views] == ["As chosen", "Front", "Right", "Back", "Left", "Top"]
    assert views[0][1] is scene.camera


def test_each_side_is_seen_from_where_its_name_says() -> None:
    views = dict(viewpoints(scene_of(three_items())))
    toward = {"Front": (0, -1), "Right": (1, 0), "Back": (0, 1), "Left": (-1, 0)}
    for name, (x, y) in toward.items():
        back = axes_of(views[name]).back
        assert back[:2] @ [x, y] > 0.9
        assert 0 < back[2] < 0.4
    assert axes_of(views["Top"]).back == pytest.approx([0, 0, 1])


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_every_view_is_framed_as_the_document_wishes(projection: str) -> None:
    scene = scene_of(three_items(view={"projection": projection, "margin": 0.15}), aspect=0.8)
    vertices = vertices_of(scene)
    for _, camera in viewpoints(scene):
        assert camera.aspect == 0.8
        assert np.abs(seen_by(camera, vertices)[:, :2]).max() == pytest.approx(0.7, abs=1e-3)


def test_the_wishes_are_found_again_in_the_camera() -> None:
    wishes = {"field_of_view": 47.0, "margin": 0.2, "from": (1.0, 2.0, 2.0)}
    scene = scene_of(three_items(view=wishes))
    view = view_of(scene, vertices_of(scene))
    assert view.projection == "perspective"
    assert view.field_of_view == pytest.approx(47)
    assert view.margin == pytest.approx(0.2, abs=1e-6)
    assert view.from_ == pytest.approx((1 / 3, 2 / 3, 2 / 3))


def test_an_empty_scene_has_views_too() -> None:
    assert len(viewpoints(scene_of(program_of(items=[])))) == 6
