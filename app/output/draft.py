"""Draft pictures: the scene as PNG within a fraction of a second, by OpenGL."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from PIL import Image

from app.arrays import Floats
from app.errors import RendererUnavailable
from app.output.draft_light import lighting
from app.output.draft_scene import Normalization, draft_scene
from app.output.draft_view import PLAIN, Frame, Pixels, Sampling, Tiling, frame, sampling, tiling
from app.output.gl_context import with_renderer
from app.output.gl_platform import draft_problem
from app.output.png import encode_png
from app.scene.scene import Camera, Light, Material, Node, Primitive, Scene
from app.solids.mesh import Mesh

__all__ = ["draft_problem", "draw_draft", "draw_pixel", "draw_views"]

TOGETHER = 6
"""Pictures that are drawn at once: some megabytes each."""


def draw_draft(scene: Scene, width: int, height: int) -> bytes:
    """The scene as a PNG of ``width`` by ``height`` pixels, smooth and with shadows.

    RGB, or RGBA where the scene has no background. The ground is drawn as nothing but the
    shadows on it: away from them the background is exact, and there is no rim to be seen.
    Raises `RendererUnavailable` where this machine has no OpenGL.
    """
    return encode_png(draw(scene, width, height, sampling(width, height, _triangles(scene))))


def draw_views(
    scene: Scene, cameras: Sequence[Camera], width: int, height: int
) -> Iterator[Image.Image]:
    """The scene from each of ``cameras``, as `draw_draft` would draw it, in turn.

    The light stays where it is. Several pictures are drawn at once, so that shadows are drawn once
    for them.
    """
    how = sampling(width, height, _triangles(scene))
    is_clear = any(material.base_color[3] < 1.0 for material in scene.materials)
    together = 1 if is_clear else TOGETHER
    for first in range(0, len(cameras), together):
        yield from _pictures(scene, cameras[first : first + together], width, height, how)


def draw(scene: Scene, width: int, height: int, how: Sampling) -> Image.Image:
    """As `draw_draft`, but pixels, and as smooth as ``how`` says."""
    return next(_pictures(scene, [scene.camera], width, height, how))


def _pictures(
    scene: Scene, cameras: Sequence[Camera], width: int, height: int, how: Sampling
) -> Iterator[Image.Image]:
    for pixels in _draw(scene, cameras, width * how.scale, height * how.scale, how):
        size = pixels.shape[1], pixels.shape[0]
        if scene.background is None:
            # Scaled while colours are multiplied by opacity: else the edges would turn dark.
            picture = Image.frombytes("RGBa", size, pixels.tobytes())
        else:
            picture = Image.frombytes("RGB", size, pixels.tobytes(), "raw", "RGBX")
        if how.scale > 1:
            picture = picture.resize((width, height), Image.Resampling.BICUBIC)
        yield picture.convert("RGBA") if scene.background is None else picture


def _triangles(scene: Scene) -> int:
    return sum(len(primitive.mesh.faces) for node in scene.nodes for primitive in node.primitives)


def draw_pixel() -> None:
    """Draw one pixel, to learn whether this machine can, and to be quick with the next.

    For a process that draws: it loads OpenGL. Raises `RendererUnavailable` where nothing comes.
    """
    picture = draw(_TEST_CARD, 1, 1, PLAIN)
    if picture.getpixel((0, 0)) == (0, 0, 0):
        raise RendererUnavailable("OpenGL starts on this machine, but draws nothing.")


def _draw(
    scene: Scene, cameras: Sequence[Camera], width: int, height: int, how: Sampling
) -> list[Pixels]:
    background = _clear_color(scene)
    light = lighting(scene.lights)
    normalization = Normalization.of(scene)
    draft = draft_scene(replace(scene, camera=cameras[0]), normalization, light.sun)
    pictures = [np.zeros((height, width, 4), dtype=np.uint8) for _ in cameras]
    if draft.bounds is None:
        for pixels in pictures:
            pixels[:] = np.round(background * 255)
        return pictures
    tiles = tiling(width, height, how.tile_side)
    corners = list(tiles.corners())
    wholes = [frame(camera, normalization, draft.corners, width / height) for camera in cameras]
    drawn = with_renderer(
        lambda renderer: renderer.draw(
            draft,
            light,
            background,
            [_tile(whole, corner, tiles, width, height) for whole in wholes for corner in corners],
            size=(tiles.width, tiles.height),
            samples=how.samples,
        )
    )
    places = ((pixels, corner) for pixels in pictures for corner in corners)
    for (pixels, (left, top)), tile in zip(places, drawn, strict=True):
        place = pixels[top : top + tiles.height, left : left + tiles.width]
        place[:] = tile[: place.shape[0], : place.shape[1]]
    return pictures


def _tile(whole: Frame, corner: tuple[int, int], tiles: Tiling, width: int, height: int) -> Frame:
    left, top = corner
    return whole.window(
        left / width, top / height, (left + tiles.width) / width, (top + tiles.height) / height
    )


def _clear_color(scene: Scene) -> Floats:
    """The background as sRGB and opacity, (4,), each a whole number of 255ths."""
    if scene.background is None:
        return np.zeros(4)
    linear = np.clip(np.asarray(scene.background, dtype=np.float64), 0.0, 1.0)
    srgb = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
    )
    return np.append(np.round(srgb * 255) / 255, 1.0)


def _test_card() -> Scene:
    """A white square seen from above, with all that a usual scene has."""
    square = Mesh(
        vertices=np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=np.float32),
        normals=np.array([[0, 0, 1]] * 4, dtype=np.float32),
        faces=np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32),
    )
    paper = Material("paper", (1.0, 1.0, 1.0, 1.0), 0.0, 1.0)
    at, upright = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    item = Node("item", "item", (Primitive(square, 0),), at, upright, {})
    ground = Node("ground", "ground", (Primitive(square, 0),), at, upright, {})
    return Scene(
        name="test card",
        nodes=(item, ground),
        materials=(paper,),
        lights=tuple(
            Light(name, (0.3, 0.4, -1.0), (1.0, 1.0, 1.0), 1.0, name == "key")
            for name in ("key", "fill", "rim")
        ),
        camera=Camera((0.0, 0.0, 3.0), at, (0.0, 1.0, 0.0), 1.0, 0.1, 10.0, height=1.0),
        background=(0.0, 0.0, 0.0),
        bounds=np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 0.0]]),
    )


_TEST_CARD = _test_card()
