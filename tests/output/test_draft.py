"""Draft pictures, judged by their pixels."""

from __future__ import annotations

import io
import os
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import psutil
import pytest
from numpy.typing import NDArray
from PIL import Image

from app.errors import RendererUnavailable
from app.output.draft import draft_problem, draw, draw_draft, draw_pixel
from app.output.draft_view import DOUBLED, PLAIN, SAMPLED, Sampling
from app.output.gl_platform import Platform, find_platform
from app.scene.scene import Scene
from app.settings import settings
from tests.conftest import require
from tests.output.scenes import (
    WHITE,
    arch,
    box,
    from_above,
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
    assert at(seen[0.35], 0, 0).sum() > at(seen[1.0], 0, 0).sum() + 150
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


def test_edges_are_smooth_however_they_are_smoothed() -> None:
    turned = node("tube", arch((-1.5, -0.4, 0.5), (1.5, 0.5, 0.5), 0.0, 0.3), 0, shows="hyperedge")
    shown = scene([turned], [matte("#000000")], ground=False)
    for how in (DOUBLED, SAMPLED):
        picture = np.asarray(draw(shown, 200, 200, how)).astype(np.int64)
        between = (picture[..., 0] > 60) & (picture[..., 0] < 200)
        assert between.sum() > 150, how


def test_tiles_join_without_a_seam() -> None:
    whole = np.asarray(draw(still_life(), 200, 150, PLAIN)).astype(np.int64)
    tiled = np.asarray(draw(still_life(), 200, 150, Sampling(1, 1, tile_side=64))).astype(np.int64)
    assert difference(whole, tiled).max() < 3


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


def test_a_pixel_can_be_drawn() -> None:
    draw_pixel()


DRAW = """
import sys
from app.output.draft import draw_draft
from tests.output.scenes import still_life
sys.stdout.buffer.write(draw_draft(still_life(), 240, 180))
"""


def elsewhere(platform: str) -> bytes:
    """The still life, drawn in a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", DRAW],
        env={**os.environ, "TUBELOOM_GL_PLATFORM": platform},
        cwd=Path(__file__).parents[2],
        check=True,
        capture_output=True,
    ).stdout


def test_another_process_draws_the_same_bytes() -> None:
    assert elsewhere("auto") == draw_draft(still_life(), 240, 180)


def test_egl_and_osmesa_draw_alike() -> None:
    here = find_platform(settings().gl_platform)
    other: Platform = "egl" if here == "osmesa" else "osmesa"
    try:
        find_platform(other)
    except RendererUnavailable as problem:
        require(False, str(problem))
    picture = np.asarray(Image.open(io.BytesIO(elsewhere(other)))).astype(np.int64)
    assert difference(picture, pixels(still_life(), 240, 180)).mean() < 0.5
