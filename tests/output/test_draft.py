"""Draft pictures, judged by their pixels."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import psutil
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import RendererUnavailable
from app.output.draft import depths, draft_problem, draw, draw_draft, draw_pixel, draw_views
from app.output.gl_platform import Platform, find_platform
from app.scene.grain import textured
from app.scene.materials import Look, make_material
from app.scene.scene import Camera, Light, Node, Primitive, Scene
from app.settings import settings
from app.solids.mesh import Mesh
from tests.children import SCRIPT_SECONDS
from tests.conftest import require
from tests.output.scenes import (
    WHITE,
    arch,
    box,
    from_above,
    from_front,
    linear,
    matte,
    node,
    scene,
    still_life,
    sun,
)

Pixels = NDArray[np.int64]


@pytest.fixture(autouse=True, scope="module")
def opengl() -> None:
    problem = draft_problem()
    require(problem is None, str(problem))


def pixels(shown: Scene, width: int = 200, height: int = 200) -> Pixels:
    """The picture as (height, width, channels), by way of its PNG."""
    return np.asarray(Image.open(io.BytesIO(draw_draft(shown, width, height)))).astype(np.int64)


def at(picture: Pixels, x: float, y: float, height: float = 4.0) -> Pixels:
    """The pixel that shows (x, y) in a square picture taken from above."""
    side = len(picture)
    row, column = round(side / 2 - y / height * side), round(side / 2 + x / height * side)
    return np.asarray(picture[row, column])


def lab(srgb: NDArray[np.int64]) -> NDArray[np.float64]:
    """CIE L*a*b* (D65) of sRGB from 0 to 255, (…, 3)."""
    encoded = srgb / 255
    rgb = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    to_xyz = np.array(
        [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    )
    xyz = rgb @ to_xyz.T / np.array([0.9505, 1.0, 1.089])
    root = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    x, y, z = np.moveaxis(root, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def difference(one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.float64]:
    """Distance of colours in CIE L*a*b*: 2 is just seen, 100 is black to white."""
    return np.asarray(np.linalg.norm(lab(one) - lab(other), axis=-1))


def rgb(color: str) -> Pixels:
    return np.array(list(bytes.fromhex(color[1:])))


def ball_mesh() -> Mesh:
    """A ball of radius 0.7."""
    turn, rise = np.meshgrid(np.linspace(0, 2 * np.pi, 41), np.linspace(-np.pi / 2, np.pi / 2, 21))
    normals = np.stack(
        [np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)], axis=-1
    )
    row, column = np.mgrid[:20, :40]
    corner = (41 * row + column).ravel()
    faces = np.concatenate(
        [
            np.stack([corner, corner + 1, corner + 42], axis=1),
            np.stack([corner, corner + 42, corner + 41], axis=1),
        ]
    )
    normals = normals.reshape(-1, 3).astype(np.float32)
    return Mesh(normals * np.float32(0.7), normals, faces.astype(np.uint32))


CUBE = node("cube", box(1, 1, 1), 0, (0.0, 0.0, 0.5))


def test_a_picture_is_a_png_of_the_size_asked_for_that_says_it_is_srgb() -> None:
    body = draw_draft(scene([CUBE], [matte("#d55e00")]), 120, 90)
    picture = Image.open(io.BytesIO(body))
    assert (picture.format, picture.size, picture.mode) == ("PNG", (120, 90), "RGB")
    assert picture.info["srgb"] == 0


def test_a_picture_carries_no_time_and_no_text() -> None:
    body = draw_draft(still_life(), 40, 30)
    chunks = set()
    start = 8
    while start < len(body):
        length, kind = int.from_bytes(body[start : start + 4], "big"), body[start + 4 : start + 8]
        checked = body[start + 4 : start + 8 + length]
        assert zlib.crc32(checked) == int.from_bytes(body[start + 8 + length :][:4], "big")
        chunks.add(kind)
        start += 12 + length
    assert chunks == {b"IHDR", b"sRGB", b"IDAT", b"IEND"}


@pytest.mark.parametrize("color", ["#d55e00", "#56b4e9", "#f0e442", "#1b1f27", "#64748b"])
def test_a_matte_face_turned_to_the_light_shows_its_own_color(color: str) -> None:
    picture = pixels(scene([CUBE], [matte(color)], lights=[sun((0.0, 0.0, -1.0))]))
    assert difference(at(picture, 0, 0), rgb(color)) < 8


@pytest.mark.parametrize("color", ["#ffffff", "#17202e", "#fef3c7", "#808080"])
def test_the_background_is_exact_away_from_the_shadows(color: str) -> None:
    picture = pixels(scene([CUBE], [matte("#d55e00")], background=linear(color)))
    assert (picture[:20] == rgb(color)).all()
    assert (picture[:, :20] == rgb(color)).all()
    assert (picture[-20:] == rgb(color)).all()


def test_a_shadow_falls_where_the_sun_throws_it() -> None:
    picture = pixels(scene([CUBE], [matte("#d55e00")], lights=[sun((1.0, 0.0, -1.0))]))
    shadow, beside, beyond = (at(picture, x, 0.0) for x in (1.2, -1.2, 1.75))
    assert shadow.max() < 225
    assert beside.min() > 245
    assert beyond.min() > 240


def test_the_ground_darkens_softly_around_what_stands_on_it() -> None:
    lights = [sun((0.0, 0.0, -1.0))]
    picture = pixels(scene([CUBE], [matte("#d55e00")], lights=lights))
    near, far = at(picture, 0.55, 0.0), at(picture, 1.5, 0.0)
    assert near.max() < 240
    assert (far == 255).all()


def test_without_a_ground_nothing_catches_shadows() -> None:
    picture = pixels(
        scene([CUBE], [matte("#d55e00")], lights=[sun((1.0, 0.0, -1.0))], ground=False)
    )
    assert (at(picture, 1.2, 0.0) == 255).all()


def test_an_item_casts_its_shadow_on_another() -> None:
    wall = node("wall", box(0.2, 1, 2), 0, (-0.6, 0.0, 1.0))
    lights = [sun((0.5, 0.0, -1.0))]
    alone = pixels(scene([CUBE], [matte("#ffffff")], lights=lights))
    shaded = pixels(scene([CUBE, wall], [matte("#ffffff")], lights=lights))
    assert at(shaded, -0.3, 0.0).max() < at(alone, -0.3, 0.0).min() - 20
    assert difference(at(shaded, 0.3, 0.0), at(alone, 0.3, 0.0)) < 5


def test_flat_surfaces_in_the_light_have_no_speckles() -> None:
    table = node("table", box(3, 3, 0.2), 0, (0.0, 0.0, 0.1))
    low_sun = [sun((1.0, 0.3, -0.8))]
    picture = pixels(scene([table], [matte("#b0b0b0")], lights=low_sun))
    top = picture[40:160, 40:160]
    assert np.ptp(top, axis=(0, 1)).max() <= 2


def test_glass_shows_what_is_behind_it_and_casts_a_lighter_shadow() -> None:
    lights = [sun((1.0, 0.0, -1.0))]
    seen = {
        opacity: pixels(scene([CUBE], [matte("#2563eb", opacity)], lights=lights))
        for opacity in (0.35, 1.0)
    }
    assert at(seen[0.35], 0, 0).sum() > at(seen[1.0], 0, 0).sum() + 140
    assert at(seen[1.0], 1.2, 0).max() + 15 < at(seen[0.35], 1.2, 0).max() < 250


def test_shadows_of_glass_have_no_pattern() -> None:
    lights = [sun((1.0, 0.0, -1.0))]
    picture = pixels(scene([CUBE], [matte("#2563eb", 0.5)], lights=lights))
    side = len(picture)
    shadow = picture[side // 2 - 10 : side // 2 + 10, round(0.78 * side) : round(0.84 * side)]
    assert np.abs(np.diff(shadow[..., 0], axis=0)).max() <= 2


def test_the_nearer_of_two_translucent_items_is_blended_last() -> None:
    low = node("low", box(1, 1, 0.2), 0, (0.0, 0.0, 0.1))
    high = node("high", box(1, 1, 0.2), 1, (0.0, 0.0, 1.1))
    materials = [matte("#ff0000", 0.6), matte("#0000ff", 0.6)]
    for nodes in ([low, high], [high, low]):
        red, _, blue = at(pixels(scene(nodes, materials)), 0, 0)
        assert blue > red + 50


def test_opaque_items_hide_what_is_behind_them_in_any_order() -> None:
    low = node("low", box(1, 1, 0.2), 0, (0.0, 0.0, 0.1))
    high = node("high", box(1, 1, 0.2), 1, (0.0, 0.0, 1.1))
    materials = [matte("#ff0000"), matte("#0000ff")]
    for nodes in ([low, high], [high, low]):
        red, _, blue = at(pixels(scene(nodes, materials)), 0, 0)
        assert blue > red + 100


def test_right_is_right_and_up_is_up() -> None:
    places = [(1.0, 1.0, 0.2), (-1.0, 1.0, 0.2), (1.0, -1.0, 0.2)]
    colors = ["#d55e00", "#009e73", "#0072b2"]
    nodes = [node(str(k), box(0.6, 0.6, 0.4), k, place) for k, place in enumerate(places)]
    picture = pixels(scene(nodes, [matte(color) for color in colors]))
    for (x, y, _), color in zip(places, colors, strict=True):
        assert difference(at(picture, x, y), rgb(color)) < 15


def test_a_transparent_picture_over_white_looks_like_one_on_white() -> None:
    on_white = pixels(still_life(WHITE), 240, 180)
    transparent = Image.open(io.BytesIO(draw_draft(still_life(None), 240, 180)))
    assert transparent.mode == "RGBA"
    paper = Image.new("RGBA", transparent.size, "white")
    paper.alpha_composite(transparent)
    composed = np.asarray(paper)[..., :3].astype(np.int64)
    assert difference(composed, on_white).mean() < 0.5


def test_a_transparent_picture_is_clear_solid_and_in_shadow_where_it_should_be() -> None:
    lights = [sun((1.0, 0.0, -1.0))]
    picture = pixels(scene([CUBE], [matte("#d55e00")], lights=lights, background=None))
    assert (picture[:20] == 0).all()
    assert at(picture, 0, 0)[3] == 255
    shadow = at(picture, 1.2, 0.0)
    assert 25 < shadow[3] < 130
    assert shadow[:3].max() < 60


def test_edges_are_smooth() -> None:
    turned = node("tube", arch((-1.5, -0.4, 0.5), (1.5, 0.5, 0.5), 0.0, 0.3), 0, shows="hyperedge")
    shown = scene([turned], [matte("#000000")], ground=False)
    between = {}
    for samples in (1, 4):
        picture = np.asarray(draw(shown, 200, 200, samples)).astype(np.int64)
        between[samples] = ((picture[..., 0] > 60) & (picture[..., 0] < 200)).sum()
    assert between[4] > 150
    assert between[1] < 20


def test_tiles_join_without_a_seam() -> None:
    whole = np.asarray(draw(still_life(), 200, 150, samples=4)).astype(np.int64)
    tiled = np.asarray(draw(still_life(), 200, 150, samples=4, side=64)).astype(np.int64)
    apart = difference(whole, tiled)
    assert (apart > 3).sum() <= 5  # edges, where a sample may fall on the other side
    assert apart.mean() < 0.01


def test_nothing_to_draw_is_the_background_alone() -> None:
    empty = scene([], [matte("#ffffff")], background=linear("#fef3c7"))
    assert (pixels(empty, 30, 20) == rgb("#fef3c7")).all()
    clear = pixels(scene([], [matte("#ffffff")], background=None), 30, 20)
    assert clear.shape == (20, 30, 4)
    assert (clear == 0).all()


@pytest.mark.parametrize(("width", "height"), [(1, 1), (16, 4096), (4096, 16), (3, 7)])
def test_any_size_comes_out_as_asked_for(width: int, height: int) -> None:
    assert pixels(still_life(), width, height).shape == (height, width, 3)


def test_the_shape_of_the_picture_does_not_distort_the_scene() -> None:
    picture = pixels(scene([CUBE], [matte("#000000")], lights=[sun((0, 0, -1.0))]), 300, 100)
    dark = picture[..., 0] < 100
    assert dark.any(axis=0).sum() == pytest.approx(dark.any(axis=1).sum(), abs=1)


@pytest.mark.parametrize("scale", [1e-4, 1e5])
def test_a_scene_of_any_scale_looks_the_same(scale: float) -> None:
    def shown(size: float) -> Scene:
        cube = node("cube", box(size, size, size), 0, (size * 7, -size * 3, size / 2))
        camera = from_above(4 * size)
        moved = type(camera)(
            (7 * size, -3 * size, 10 * size),
            (7 * size, -3 * size, 0.0),
            camera.up,
            1.0,
            0.1 * size,
            20 * size,
            height=4 * size,
        )
        return scene([cube], [matte("#d55e00")], camera=moved)

    # The ground of `scene` is 40 wide and 0.0005 below: let both stand on its top.
    assert difference(pixels(shown(1.0)), pixels(shown(scale))).mean() < 0.5


def test_a_vertex_that_is_not_finite_is_an_error_and_no_picture() -> None:
    broken = box(1, 1, 1)
    broken.vertices[3, 1] = np.nan
    with pytest.raises(ValueError, match="broken"):
        draw_draft(scene([node("broken", broken, 0)], [matte("#ffffff")]), 20, 20)


def test_a_scene_without_lights_is_lit_by_the_sky() -> None:
    picture = pixels(scene([CUBE], [matte("#ffffff")], lights=[]))
    assert at(picture, 0, 0).min() > 200


def test_the_same_scene_gives_the_same_bytes_from_any_thread() -> None:
    with ThreadPoolExecutor(4) as threads:
        bodies = list(threads.map(lambda _: draw_draft(still_life(), 160, 120), range(6)))
    assert len(set(bodies)) == 1


def test_pictures_in_a_row_take_no_more_memory() -> None:
    process = psutil.Process()
    for seed in range(10):
        draw_draft(still_life(seed=seed), 160, 120)
    before = process.memory_info().rss
    for seed in range(40):
        draw_draft(still_life(seed=seed), 160, 120)
    assert process.memory_info().rss - before < 8e6


def tubes_that_cross(gap: float, *colors: str, far: float = 1.0) -> Scene:
    """Two tubes, the second from left to right above the first, which runs up the picture."""
    places = (((0, -1.8, 0.3), (0, 1.8, 0.3)), ((-1.8, 0, 0.3 + far), (1.8, 0, 0.3 + far)))
    tubes = [
        replace(
            node(str(k), arch(start, end, 0.0, 0.2), k, shows="hyperedge"),
            radius=0.2,
        )
        for k, (start, end) in enumerate(places)
    ]
    lights = [Light("above", (0.0, 0.0, -1.0), WHITE, 3.0, casts_shadows=False)]
    shown = scene(tubes, [matte(color) for color in colors], lights=lights, ground=False)
    return replace(shown, halo=gap)


def test_a_tube_leaves_a_gap_in_another_that_passes_behind_it() -> None:
    without, with_gap = (
        pixels(tubes_that_cross(gap, "#0000ff", "#ff0000"), 400, 400) for gap in (0.0, 0.5)
    )
    beside = 0.2 + 0.05  # of the front tube's middle: within its gap of 0.5 · 0.2
    assert at(without, 0, beside)[2] > at(without, 0, beside)[0] + 100
    assert (at(with_gap, 0, beside) > 240).all()
    for x, y in ((0, 0), (0, 0.4), (1, 0.0), (1, 0.15)):
        assert difference(at(with_gap, x, y), at(without, x, y)) < 3


def test_a_gap_shows_what_is_behind_the_tube_and_cuts_no_item() -> None:
    shown = tubes_that_cross(0.5, "#0000ff", "#ff0000")
    plate = node("plate", box(3, 3, 0.1), 2, (0.0, 0.0, 0.0))
    shown = replace(
        shown, nodes=(*shown.nodes, plate), materials=(*shown.materials, matte("#00ff00"))
    )
    picture = pixels(shown, 400, 400)
    for x in (0.0, 0.6):
        red, green, blue = at(picture, x, 0.25)
        assert green > max(red, blue) + 100


def test_gaps_have_smooth_edges() -> None:
    picture = pixels(tubes_that_cross(0.5, "#000000", "#ff0000"), 390, 390)
    red, green, _ = np.moveaxis(picture[:, 190:200], -1, 0)
    at_edges = (green > 40) & (green < 215) & (abs(red - green) < 20)
    assert at_edges.any(axis=0).all()


def test_tubes_of_one_hyperedge_have_no_gaps_where_they_meet() -> None:
    shown = tubes_that_cross(0.5, "#0000ff", "#ff0000", far=0.3)
    low, high = (part.primitives[0].mesh for part in shown.nodes)
    joined = Mesh(
        np.concatenate([low.vertices, high.vertices]),
        np.concatenate([low.normals, high.normals]),
        np.concatenate([low.faces, high.faces + np.uint32(len(low.vertices))]),
    )
    one = replace(shown.nodes[0], primitives=(Primitive(joined, 0),))
    with_gap = pixels(replace(shown, nodes=(one,)))
    without = pixels(replace(shown, nodes=(one,), halo=0.0))
    np.testing.assert_array_equal(with_gap, without)


def test_of_glass_that_overlaps_itself_only_the_front_is_seen() -> None:
    glass, lights = matte("#2563eb", 0.5), [sun((0.0, 0.0, -1.0))]
    outer, inner = box(1.2, 1.2, 0.8), box(0.6, 0.6, 0.4)
    both = Mesh(
        np.concatenate([outer.vertices, inner.vertices]),
        np.concatenate([outer.normals, inner.normals]),
        np.concatenate([outer.faces, inner.faces + np.uint32(len(outer.vertices))]),
    )
    alone, filled = (
        pixels(scene([node("one", mesh, 0, (0.0, 0.0, 0.4))], [glass], lights=lights))
        for mesh in (outer, both)
    )
    np.testing.assert_array_equal(alone, filled)


def test_glass_is_seen_through_glass_in_the_order_of_each_place() -> None:
    # Two planks that are woven: each is in front of the other at one of their crossings.
    def plank(name: str, material: int, way: int) -> Node:
        mesh = box(3.0, 0.5, 0.1)
        slanted = mesh.vertices.copy()
        slanted[:, 2] += way * 0.5 * slanted[:, 0] + 1.0
        return node(name, Mesh(slanted, mesh.normals, mesh.faces), material)

    planks = [plank("one", 0, 1), plank("other", 1, -1)]
    materials = [matte("#ff0000", 0.7), matte("#0000ff", 0.7)]
    for nodes in (planks, planks[::-1]):
        picture = pixels(scene(nodes, materials, ground=False))
        right, left = at(picture, 0.8, 0.0), at(picture, -0.8, 0.0)
        assert right[0] > right[2] + 50
        assert left[2] > left[0] + 50


def test_layers_of_glass_that_there_was_no_room_for_are_all_seen() -> None:
    panes = [node(str(k), box(2, 2, 0.02), 0, (0.0, 0.0, 0.2 * k)) for k in range(40)]
    shown = scene(panes, [matte("#000000", 0.1)], ground=False)
    picture = pixels(shown, 300, 300)
    assert at(picture, 0, 0).max() < 20
    assert np.ptp(picture[100:200, 100:200], axis=(0, 1)).max() <= 2


@pytest.mark.parametrize("color", ["#8b5cf6", "#102030", "#ffffff"])
def test_what_is_plain_shows_its_color_exactly_on_all_sides(color: str) -> None:
    cube = node("cube", box(1, 1, 1), 0, (0.0, 0.0, 0.5))
    shown = scene([cube], [make_material("plain", color)], camera=from_front())
    picture = pixels(shown, 120, 120)
    inside = picture[50:62, 50:62]
    assert (inside == rgb(color)).all()


def test_wood_has_a_grain_in_the_tint_of_its_color() -> None:
    block = textured(box(2, 2, 0.5), "wood")
    lights = [sun((0.5, 0.2, -1.0))]
    shown = scene([node("block", block, 0)], [make_material("wood", "#b98a5a")], lights=lights)
    top = pixels(shown)[60:140, 60:140]
    assert top.std(axis=(0, 1)).min() > 3
    assert difference(top.mean(axis=(0, 1)).astype(np.int64), rgb("#b98a5a")) < 15


def test_metal_mirrors_its_surroundings() -> None:
    ball = node("ball", ball_mesh(), 0, (0.0, 0.0, 0.8))
    metal, paper = (
        pixels(scene([ball], [material], camera=from_front(), lights=[sun()]))
        for material in (make_material(Look("metal", "shiny"), "#c0c5ce"), matte("#c0c5ce"))
    )
    ball_of = (slice(60, 110), slice(75, 125))
    assert metal[ball_of].std() > 1.15 * paper[ball_of].std()


def test_views_are_what_each_camera_alone_would_give() -> None:
    shown = still_life()
    turned = replace(shown.camera, position=(3.0, -5.0, 4.5))
    flat = from_above(5.0)
    views = list(draw_views(shown, [shown.camera, turned, flat, shown.camera], 120, 90))
    alone = [draw(replace(shown, camera=one), 120, 90, 4) for one in (shown.camera, turned, flat)]
    for view, picture in zip(views, [*alone, alone[0]], strict=True):
        assert view.mode == "RGB"
        assert difference(np.asarray(view).astype(int), np.asarray(picture).astype(int)).max() < 3


def test_views_may_be_left_before_the_last_and_drawn_at_once_with_others() -> None:
    one, other = still_life(seed=1), still_life(seed=2)
    mixed = []
    for first, second in zip(
        draw_views(one, [one.camera] * 3, 80, 60),
        draw_views(other, [other.camera] * 5, 80, 60),
        strict=False,
    ):
        mixed.append((first, second))
    for first, second in mixed:
        assert first.tobytes() == draw(one, 80, 60, 4).tobytes()
        assert second.tobytes() == draw(other, 80, 60, 4).tobytes()


def test_views_without_a_background_are_transparent() -> None:
    shown = still_life(None)
    (view,) = draw_views(shown, [shown.camera], 60, 40)
    assert (view.mode, view.getpixel((0, 0))) == ("RGBA", (0, 0, 0, 0))


@pytest.mark.parametrize("camera", [from_above(4.0), from_front()])
def test_depths_are_distances_along_the_axis(camera: Camera) -> None:
    seen = depths(scene([CUBE], [matte("#d55e00")], camera=camera), 101, 101)
    axis = np.subtract(camera.target, camera.position)
    axis = axis / np.linalg.norm(axis)
    corners = CUBE.primitives[0].mesh.vertices + np.array(CUBE.translation)
    away = (corners - camera.position) @ axis
    found = seen[np.isfinite(seen)]
    assert np.isinf(seen[0, 0])
    assert len(found) > 300
    assert found.min() == pytest.approx(away.min(), abs=0.03)
    assert found.max() < away.max()
    if camera.height is not None:
        np.testing.assert_allclose(found, 9.0, atol=1e-5)


def test_depths_of_a_large_picture_are_put_together_of_tiles() -> None:
    shown = scene([CUBE], [matte("#d55e00")])
    seen = depths(shown, 1500, 1500)
    assert seen.shape == (1500, 1500)
    inside = np.isfinite(seen)
    assert inside.sum() == pytest.approx((1500 / 4) ** 2, rel=0.01)
    assert inside[600:900, 600:900].all()


def test_of_nothing_depths_are_infinite() -> None:
    assert np.isinf(depths(scene([], [matte("#ffffff")]), 4, 3)).all()


def test_a_pixel_can_be_drawn() -> None:
    draw_pixel()


def everything() -> Scene:
    """The still life with halos, wood, stone, and glass that tubes pass."""
    shown = still_life()
    grains: tuple[Literal["wood", "stone"], ...] = ("wood", "stone")
    blocks = tuple(
        node(name, textured(box(0.5, 0.5, 0.8), name), 8 + k, (0.6 * (2 * k - 1), -1.8, 0.4))
        for k, name in enumerate(grains)
    )
    tubes = tuple(
        replace(part, radius=0.06) if part.shows == "hyperedge" else part for part in shown.nodes
    )
    woods = tuple(make_material(name, "#b98a5a") for name in grains)
    return replace(shown, nodes=(*tubes, *blocks), materials=(*shown.materials, *woods), halo=0.4)


DRAW = """
import sys
from app.output.draft import draw_draft
from tests.output.test_draft import everything
sys.stdout.buffer.write(draw_draft(everything(), 240, 180))
"""


def elsewhere(platform: str) -> bytes:
    """Everything, drawn in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", DRAW],
        env={**os.environ, "TUBELOOM_GL_PLATFORM": platform},
        cwd=Path(__file__).parents[2],
        check=True,
        capture_output=True,
        timeout=SCRIPT_SECONDS,
    ).stdout


def test_another_process_draws_the_same_bytes() -> None:
    assert elsewhere("auto") == draw_draft(everything(), 240, 180)


def test_egl_and_osmesa_draw_alike() -> None:
    here = find_platform(settings().gl_platform)
    other: Platform = "egl" if here == "osmesa" else "osmesa"
    try:
        find_platform(other)
    except RendererUnavailable as problem:
        require(False, str(problem))
    picture = np.asarray(Image.open(io.BytesIO(elsewhere(other)))).astype(np.int64)
    assert difference(picture, pixels(everything(), 240, 180)).mean() < 0.1
