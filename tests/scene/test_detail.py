"""Level of detail: nobody sees in the picture asked for how far tubes are off."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program, View
from app.scene.assemble import assemble
from app.scene.detail import COARSEST, UNSEEN, Detail
from app.scene.scene import Scene
from app.staging import make_scene
from app.tubes.sweep import sweep
from tests.output.woven_scenes import program_in_a_grid
from tests.scene.hand_built import seen_by

ASPECT = 4 / 3
FINEST = 1e-9


def laid(**parts: Any) -> tuple[Placement, Routing]:
    program = program_in_a_grid(40, items=400, **parts)
    placement = place(program, load_notation("plain"))
    return placement, route(placement, curves="prose", clearance=None)


@pytest.fixture(scope="module")
def both() -> tuple[Placement, Routing]:
    """Forty hyperedges among four hundred items."""
    return laid()


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
@pytest.mark.parametrize("height", [100, 3000])
def test_meshes_are_off_by_a_tenth_of_a_pixel_at_most(
    projection: Any, height: int, both: tuple[Placement, Routing]
) -> None:
    program = program_in_a_grid(40, items=400, view={"projection": projection})
    placement, routing = both
    allowed = Detail.of(placement, routing, program.view, ASPECT, height).tubes(routing, FINEST)
    tubes = sweep(routing, allowed)
    camera = assemble(program, load_notation("plain"), placement, tubes, ASPECT).camera
    for number, off in enumerate(allowed):
        vertices = tubes.mesh(number).vertices[:1].astype(np.float64)
        up = np.array(camera.up) * off
        pixels = (seen_by(camera, vertices + up) - seen_by(camera, vertices))[:, 1] * height / 2
        # Items are seen as boxes, edges and all, and so from a little farther away.
        assert np.abs(pixels).max() <= 1.02 * UNSEEN


def test_far_tubes_may_be_off_further(both: tuple[Placement, Routing]) -> None:
    view = View.model_validate({"from": [0, -1, 0.1], "field_of_view": 60})
    placement, routing = both
    allowed = Detail.of(placement, routing, view, ASPECT, 1000).tubes(routing, FINEST)
    nearest = [
        points[:, :, 1].min()
        for points in np.split(routing.control_points, routing.segment_starts[1:-1])
    ]
    assert np.corrcoef(allowed, nearest)[0, 1] > 0.99
    assert allowed.max() > 1.5 * allowed.min()


def test_twice_the_picture_is_twice_as_fine(both: tuple[Placement, Routing]) -> None:
    placement, routing = both

    def at(height: int) -> Floats:
        return Detail.of(placement, routing, View(), ASPECT, height).tubes(routing, FINEST)

    assert at(2000) == pytest.approx(at(1000) / 2)


def test_no_tube_is_off_by_more_than_half_its_radius(both: tuple[Placement, Routing]) -> None:
    placement, routing = both
    allowed = Detail.of(placement, routing, View(), ASPECT, 1).tubes(routing, FINEST)
    assert np.array_equal(allowed, COARSEST * routing.radii)


def test_no_tube_is_finer_than_the_finest(both: tuple[Placement, Routing]) -> None:
    placement, routing = both
    allowed = Detail.of(placement, routing, View(), ASPECT, 10**9).tubes(routing, 0.002)
    assert np.array_equal(allowed, np.full(40, 0.002))


def test_coarse_tubes_have_fewer_triangles_and_stay_where_they_are(
    both: tuple[Placement, Routing],
) -> None:
    placement, routing = both
    fine = sweep(routing, 0.02 * 0.08)
    coarse = sweep(
        routing, Detail.of(placement, routing, View(), ASPECT, 100).tubes(routing, 0.02 * 0.08)
    )
    assert len(coarse.faces) < len(fine.faces) / 8
    assert np.isfinite(coarse.vertices).all()
    assert np.linalg.norm(coarse.normals, axis=1) == pytest.approx(1, abs=1e-5)
    for number, control_points in enumerate(
        np.split(routing.control_points, routing.segment_starts[1:-1])
    ):
        low, high = coarse.mesh(number).bounds
        radius = routing.radii[number]
        assert (low >= control_points.min(axis=(0, 1)) - 1.01 * radius).all()
        assert (high <= control_points.max(axis=(0, 1)) + 1.01 * radius).all()


def test_without_items_the_hyperedges_alone_are_seen() -> None:
    placement, routing = laid()
    bare = replace(
        placement,
        centers=np.zeros((0, 3)),
        rotations=np.zeros((0, 4)),
        sizes=np.zeros((0, 3)),
    )
    allowed = Detail.of(bare, routing, View(), ASPECT, 1000).tubes(routing, FINEST)
    assert (allowed > 0).all()
    assert allowed.max() < 0.1


def test_items_are_as_fine_as_shows_at_the_nearest(both: tuple[Placement, Routing]) -> None:
    placement, routing = both
    view = View.model_validate({"projection": "orthographic"})
    camera = Detail.of(placement, routing, view, ASPECT, 1000).camera
    assert camera.height is not None
    pixel = camera.height / 1000
    allowed = Detail.of(placement, routing, view, ASPECT, 1000).items()
    assert 0.5 * UNSEEN * pixel < allowed <= UNSEEN * pixel
    assert Detail.of(placement, routing, view, ASPECT, 2000).items() == allowed / 2
    near = Detail.of(placement, routing, View(), ASPECT, 1000)
    assert near.items() < near.tubes(routing, FINEST).max()


def test_where_nothing_is_seen_there_is_no_detail() -> None:
    placement = place(Program(items=(), hyperedges=()), load_notation("plain"))
    nothing = Detail.of(placement, route(placement), View(), ASPECT, 1000)
    assert nothing.items() == 0.0


def test_items_that_are_small_in_the_picture_have_fewer_triangles() -> None:
    program = program_in_a_grid(4, items=400)
    coarse, fine = (make_scene(program, ASPECT, height=height) for height in (200, 5000))
    assert triangles_of_items(coarse) < 0.5 * triangles_of_items(fine)
    assert triangles_of_items(fine) == triangles_of_items(make_scene(program, ASPECT))
    few = program_in_a_grid(1, items=4)
    usual = triangles_of_items(make_scene(few, ASPECT))
    assert triangles_of_items(make_scene(few, ASPECT, height=600)) == usual


def triangles_of_items(scene: Scene) -> int:
    return sum(
        len(part.mesh.faces)
        for node in scene.nodes
        if node.extras["shows"] == "item"
        for part in node.primitives
    )
