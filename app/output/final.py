"""Final pictures: path traced with Mitsuba 3, denoised with Open Image Denoise."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.arrays import Singles
from app.output.effort import Effort
from app.output.final_passes import Ending, Guides, Sampled, Sampler
from app.output.final_scene import FinalScene, final_scene
from app.output.final_thread import wait_for
from app.output.final_tone import melted, on_nothing, pixels
from app.output.final_variant import final_problem, mitsuba
from app.output.memory_needs import DENOISER, FINAL_SCENE, final_bytes, require, scene_bytes
from app.scene.scene import Scene

__all__ = ["Effort", "Final", "draw_final", "final_problem"]

USUAL_SAMPLES = 16
"""Of each pixel; denoised, four times as many can hardly be told from them."""

FINISHING_SECONDS = 2.5e-6
"""For each pixel: what guides and denoising take when samples are there."""

FINE_PIXELS = 1 << 20
"""Of pictures that are denoised as finely as can be; of larger ones it would take half a minute."""

TONED_PIXELS = 1 << 18
"""Made pixels of at once: it takes some 100 bytes for each."""


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
    is missing, and `MemoryError` where there is not enough.
    """
    began = time.monotonic()
    has_begun = mitsuba.cache_info().currsize > 0
    needed = final_bytes(width, height, denoise=effort.denoise, has_begun=has_begun)
    require(needed + scene_bytes(scene, *FINAL_SCENE))
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
        light = found.light[..., :3]
        if self.denoises:
            light = wait_for(lambda: _denoised(found.light, guides), alive)
        height, width, _ = light.shape
        seen = np.empty((height, width, 4 if self.transparent else 3), np.uint8)
        rows = max(TONED_PIXELS // width, 1)
        for top in range(0, height, rows):
            part = slice(top, top + rows)
            seen[part] = self._toned(light[part], found.light[part, :, 3:], guides.covered[part])
        return Image.fromarray(seen)

    def _toned(self, light: Singles, sky: Singles, covered: Singles) -> NDArray[np.uint8]:
        """Pixels of some rows; where there is ``sky`` (height, width, 1), it is 0."""
        here = np.clip(sky, 0.0, 1.0)
        if not (self.scene.hides_sky or self.scene.has_ground):
            here = np.clip(covered, 0.0, 1.0)[..., None]
        background = self.scene.background.astype(np.float32)
        light = light * here + background * (1.0 - here)
        if self.scene.has_ground:
            light = melted(light, 1.0 - covered, self.scene.background)
        seen = pixels(light)
        return on_nothing(seen, covered) if self.transparent else seen


def _denoised(light: Singles, guides: Guides) -> Singles:
    """Without noise, (height, width, 3); ``light`` has coverage as its fourth channel.

    Open Image Denoise does a large picture in tiles, which come to the same to the last bit.
    """
    import drjit
    import mitsuba_oidn

    # What tracing took, which Dr.Jit keeps for the next picture.
    drjit.flush_malloc_cache()
    found = np.empty((*light.shape[:2], 3), np.float32)
    # A device of its own gives its memory back when it goes; a shared one would keep it.
    device = mitsuba_oidn.Device(mitsuba_oidn.DeviceType.CPU)
    denoiser = device.new_filter("RT")
    denoiser.set_image("color", light)
    denoiser.set_image("albedo", guides.albedo)
    denoiser.set_image("normal", guides.normals)
    denoiser.set_image("output", found)
    denoiser.hdr = denoiser.clean_aux = True
    is_large = light.shape[0] * light.shape[1] > FINE_PIXELS
    quality = mitsuba_oidn.Quality
    denoiser.quality = quality.Balanced if is_large else quality.High
    denoiser.max_memory_mb = DENOISER
    denoiser.execute()
    return found
