"""Draft pictures: the scene as PNG within a fraction of a second, by OpenGL."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from app.arrays import Floats, Singles
from app.errors import RendererUnavailable
from app.output.draft_scene import Normalization, draft_scene
from app.output.draft_stage import stage
from app.output.draft_view import MOST_SIDE, Pixels, frame, sampling, tiling
from app.output.gl_context import begin_with_renderer, has_renderer, with_renderer
from app.output.gl_platform import draft_problem
from app.output.memory_needs import DRAFT_SCENE, draft_bytes, require, scene_bytes
from app.output.png import encode_pixels, encode_png
from app.scene.scene import Camera, Light, Material, Node, Primitive, Scene
from app.solids.mesh import Mesh

if TYPE_CHECKING:
    from app.output.draft_renderer import DraftRenderer

__all__ = ["depths", "draft_problem", "draw_draft", "draw_pixel", "draw_views"]


def draw_draft(scene: Scene, width: int, height: int) -> bytes:
    """The scene as a PNG of ``width`` by ``height`` pixels, smooth and with shadows.

    RGB, or RGBA where the scene has no background. The ground is drawn as nothing but the
    shadows on it: away from them the background is exact, and there is no rim to be seen.
    Raises `RendererUnavailable` where this machine has no OpenGL.
    """
    (pixels,) = _drawn(scene, [scene.camera], width, height, sampling(width, height))
    if scene.background is None:
        return encode_png(_picture(scene, pixels))
    return encode_pixels(pixels, channels=3)


def draw_views(
    scene: Scene, cameras: Sequence[Camera], width: int, height: int
) -> Iterator[Image.Image]:
    """The scene from each of ``cameras``, as `draw_draft` would draw it, in turn.

    The light stays where it is: so it is reckoned with once, and the scene is loaded once. While
    one picture is looked at the next is drawn.
    """
    for pixels in _drawn(scene, cameras, width, height, sampling(width, height)):
        yield _picture(scene, pixels)


def depths(scene: Scene, width: int, height: int) -> Floats:
    """How far away from the camera is what is seen, (height, width), in document units.

    Along the camera's axis, at the middle of each pixel, the first row being the highest; infinite
    where there is nothing. Without the ground; what is translucent counts as opaque, and tubes
    have no halos. Raises `RendererUnavailable` where this machine has no OpenGL.
    """
    normalization = Normalization.of(scene)
    draft = draft_scene(scene, normalization)
    if draft.bounds is None:
        return np.full((height, width), np.inf)
    whole = frame(scene.camera, normalization, draft.corners, width / height)
    tiles = tiling(width, height, MOST_SIDE)
    frames = list(tiles.frames(whole))
    size = tiles.width, tiles.height

    def draw(renderer: DraftRenderer) -> list[Singles]:
        with renderer.loaded(stage(draft, [], 1)) as loaded:
            return [renderer.depths(loaded, part, size) for part in frames]

    seen = tiles.joined(with_renderer(draw))
    return whole.distances(seen) * normalization.size


def draw(scene: Scene, width: int, height: int, samples: int, side: int = MOST_SIDE) -> Image.Image:
    """As `draw_draft`, but a picture, of so many samples in a pixel, in tiles of this ``side``."""
    (pixels,) = _drawn(scene, [scene.camera], width, height, samples, side)
    return _picture(scene, pixels)


@lru_cache(maxsize=1)
def draw_pixel() -> None:
    """Draw one pixel of a white card, to learn whether this machine can; once in each process.

    For a process that draws: it loads OpenGL. Raises `RendererUnavailable` where nothing comes.
    """
    (pixels,) = _pictures(_TEST_CARD, [_TEST_CARD.camera], 1, 1, 4, MOST_SIDE)
    if not pixels[0, 0, :3].any():
        raise RendererUnavailable("OpenGL starts on this machine, but draws nothing.")


def _drawn(
    scene: Scene,
    cameras: Sequence[Camera],
    width: int,
    height: int,
    samples: int,
    side: int = MOST_SIDE,
) -> Iterator[Pixels]:
    """One picture for each camera, by OpenGL that has been seen to draw.

    Raises `MemoryError` where there is not enough.
    """
    # Mesa does not survive every allocation that fails.
    needed = draft_bytes(width, height, has_begun=has_renderer())
    require(needed + scene_bytes(scene, *DRAFT_SCENE))
    draw_pixel()
    return _pictures(scene, cameras, width, height, samples, side)


def _pictures(
    scene: Scene,
    cameras: Sequence[Camera],
    width: int,
    height: int,
    samples: int,
    side: int,
) -> Iterator[Pixels]:
    """One picture for each camera; the next is drawn while one is looked at."""
    background = _clear_color(scene)
    normalization = Normalization.of(scene)
    draft = draft_scene(scene, normalization)
    if draft.bounds is None:
        blank = np.round(background * 255).astype(np.uint8)
        yield from (np.tile(blank, (height, width, 1)) for _ in cameras)
        return
    lit = stage(draft, scene.lights, max(width, height))
    tiles = tiling(width, height, side)
    size = tiles.width, tiles.height
    loaded = with_renderer(lambda renderer: renderer.load(lit))

    def begun(camera: Camera) -> Future[Pixels]:
        whole = frame(camera, normalization, draft.corners, width / height)
        return begin_with_renderer(
            lambda renderer: tiles.joined(
                [
                    renderer.draw(loaded, part, background, size, samples)
                    for part in tiles.frames(whole)
                ]
            )
        )

    try:
        waiting: Future[Pixels] | None = None
        for camera in cameras:
            following = begun(camera)
            if waiting is not None:
                yield waiting.result()
            waiting = following
        if waiting is not None:
            yield waiting.result()
    finally:
        with_renderer(lambda renderer: renderer.unload(loaded))


def _picture(scene: Scene, pixels: Pixels) -> Image.Image:
    size = pixels.shape[1], pixels.shape[0]
    if scene.background is None:
        return Image.frombytes("RGBa", size, pixels.data).convert("RGBA")
    return Image.frombytes("RGB", size, pixels.data, "raw", "RGBX")


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
