"""Final pictures: path traced with Mitsuba 3, denoised with Open Image Denoise."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from app.arrays import Singles
from app.output.effort import Effort
from app.output.final_passes import Ending, Guides, Sampled, Sampler
from app.output.final_scene import FinalScene, final_scene
from app.output.final_thread import wait_for
from app.output.final_tone import melted, on_nothing, pixels
from app.output.final_variant import final_problem, mitsuba
from app.scene.scene import Scene

__all__ = ["Effort", "Final", "draw_final", "final_problem"]

USUAL_SAMPLES = 16
"""Of each pixel; denoised, four times as many can hardly be told from them."""

FINISHING_SECONDS = 2.5e-6
"""For each pixel: what guides and denoising take when samples are there."""

STRIP_PIXELS = 1 << 20
"""Denoised at once: it takes some 800 bytes for each."""

OVERLAP = 64
"""Rows by which strips overlap: nothing farther away is seen in what becomes of a pixel."""


@dataclass(frozen=True, slots=True)
class Final:
    """A picture (RGB, or RGBA where the scene has no background), and how it came about.

    ``noise`` is the standard error before denoising, white being 1.
    """

    picture: Image.Image
    samples: int
    noise: float
    stopped_by: Ending


def draw_final(
    scene: Scene,
    width: int,
    height: int,
    effort: Effort,
    progress: Callable[[str, float], None],
    preview: Callable[[Image.Image], None] | None = None,
    seconds: float = math.inf,
) -> Final:
    """The scene in ``width`` by ``height`` pixels, as good as ``effort`` allows.

    ``seconds`` are what there is, whatever was wished for. ``progress`` may raise to end the work;
    ``preview`` is shown pictures that are not finished. Raises `RendererUnavailable` where Mitsuba
    is missing.
    """
    began = time.monotonic()
    progress("building", 0.0)
    renderer = wait_for(mitsuba, lambda: progress("building", 0.0))
    world = wait_for(lambda: final_scene(renderer, scene), lambda: progress("building", 0.02))
    sampler = Sampler(renderer, world, scene.camera, width, height)
    painter = _Painter(sampler, world, effort.denoise, scene.background is None)
    limit = math.inf if effort.time_limit is None else effort.time_limit
    deadline = began + min(limit, seconds) - FINISHING_SECONDS * width * height
    share = 0.02

    def told(done: float) -> None:
        nonlocal share
        share = 0.02 + 0.93 * done
        progress("path tracing", share)

    shown = 0
    for found in sampler.passes(effort, effort.samples or USUAL_SAMPLES, deadline, told):
        if found.ending is not None:
            picture = painter.paint(found, lambda: progress("denoising", 0.97))
            return Final(picture, found.samples, found.noise, found.ending)
        if preview is not None and found.samples >= 2 * shown:
            shown = found.samples
            preview(painter.paint(found, lambda: progress("path tracing", share)))
    raise AssertionError("The last pass says that it is the last.")


@dataclass(slots=True, eq=False)
class _Painter:
    """Makes pixels of what has been gathered."""

    sampler: Sampler
    scene: FinalScene
    denoises: bool
    transparent: bool
    _guides: Guides | None = None

    def paint(self, found: Sampled, alive: Callable[[], None]) -> Image.Image:
        """8 bits, sRGB."""
        alive()
        if self._guides is None:
            self._guides = self.sampler.guides(alive)
        guides = self._guides
        covered = guides.covered
        light = found.light[..., :3]
        if self.denoises:
            light = wait_for(lambda: _denoised(found.light, guides), alive)
        here = np.clip(found.light[..., 3:], 0.0, 1.0)
        if not (self.scene.hides_sky or self.scene.has_ground):
            here = np.clip(covered, 0.0, 1.0)[..., None]
        background = self.scene.background.astype(np.float32)
        light = light * here + background * (1.0 - here)
        if self.scene.has_ground:
            light = melted(light, 1.0 - covered, self.scene.background)
        seen = pixels(light)
        return Image.fromarray(on_nothing(seen, covered) if self.transparent else seen)


def _denoised(light: Singles, guides: Guides) -> Singles:
    """Without noise, (height, width, 3); ``light`` has coverage as its fourth channel."""
    import mitsuba_oidn

    quality = mitsuba_oidn.Quality
    height, width, _ = light.shape
    found = np.empty((height, width, 3), np.float32)
    strips = strips_of(height, width)
    is_large = len(strips) > 1
    if is_large:
        _give_memory_back()
    for first, last, begin, end in strips:
        strip: Any = mitsuba_oidn.denoise(
            np.ascontiguousarray(light[first:last, :, :3]),
            guides.albedo[first:last],
            guides.normals[first:last],
            hdr=True,
            clean_aux=True,
            # Of large pictures the finest would take half a minute.
            quality=quality.Balanced if is_large else quality.High,
            # Else each strip would be looked at with an exposure of its own.
            input_scale=1.0 if is_large else None,
        )
        found[begin:end] = np.asarray(strip)[begin - first : end - first]
    return found


def strips_of(height: int, width: int) -> list[tuple[int, int, int, int]]:
    """Rows to denoise at once, from first to last, and which of them to keep, from begin to end.

    >>> strips_of(480, 640), strips_of(900, 2048)
    ([(0, 480, 0, 480)], [(0, 512, 0, 448), (384, 896, 448, 832), (388, 900, 832, 900)])
    """
    rows = max(STRIP_PIXELS // width, 6 * OVERLAP)
    if rows >= height:
        return [(0, height, 0, height)]
    found = []
    begin = 0
    while begin < height:
        # The last is moved up rather than made shorter: equal sizes share what is built for them.
        first = min(max(begin - OVERLAP, 0), height - rows)
        end = height if first + rows == height else first + rows - OVERLAP
        found.append((first, first + rows, begin, end))
        begin = end
    return found


def _give_memory_back() -> None:
    """What tracing took, which Dr.Jit keeps for the next picture: gigabytes."""
    import drjit

    drjit.flush_malloc_cache()
