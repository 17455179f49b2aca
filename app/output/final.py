"""Final pictures: path traced with Mitsuba 3, denoised with Open Image Denoise."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from PIL import Image

from app.arrays import Floats, Singles
from app.output.effort import Effort
from app.output.final_passes import Ending, Sampled, Sampler
from app.output.final_scene import FinalScene, final_scene
from app.output.final_variant import final_problem, mitsuba
from app.scene.color import srgb_from_linear
from app.scene.scene import Scene

__all__ = ["Final", "draw_final", "final_problem"]

USUAL_SAMPLES = 12
"""Of each pixel; denoised, four times as many can hardly be told from them."""


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
) -> Final:
    """The scene in ``width`` by ``height`` pixels, as good as ``effort`` allows.

    ``progress`` may raise to end the work; ``preview`` is shown pictures that are not finished.
    Raises `RendererUnavailable` where Mitsuba is missing.
    """
    began = time.monotonic()
    progress("building", 0.0)
    renderer = mitsuba()
    world = final_scene(renderer, scene)
    sampler = Sampler(renderer, world, scene.camera, width, height)
    samples = effort.samples or USUAL_SAMPLES
    painter = _Painter(sampler, world, effort.denoise, scene.background is None)
    shown = 0
    for found in sampler.passes(
        effort, samples, began, lambda share: progress("path tracing", 0.95 * share)
    ):
        if found.ending is not None:
            progress("denoising", 0.95)
            return Final(painter.paint(found), found.samples, found.noise, found.ending)
        if preview is not None and found.samples >= 3 * shown:
            shown = found.samples
            preview(painter.paint(found))
    raise AssertionError("The last pass says that it is the last.")


@dataclass(slots=True, eq=False)
class _Painter:
    """Makes pixels of what has been gathered."""

    sampler: Sampler
    world: FinalScene
    denoises: bool
    transparent: bool
    _guides: tuple[Singles, Singles] | None = None

    def paint(self, found: Sampled) -> Image.Image:
        """8 bits, sRGB."""
        light = found.light[..., :3]
        if self.denoises:
            light = self._denoised(light)
        covered = np.clip(found.light[..., 3:], 0.0, 1.0)
        seen = light * covered + self.world.background * (1.0 - covered)
        return Image.fromarray(_encoded(seen))

    def _denoised(self, light: Singles) -> Singles:
        import mitsuba_oidn

        if self._guides is None:
            self._guides = self.sampler.guides()
        albedo, normals = self._guides
        found: Any = mitsuba_oidn.denoise(
            np.ascontiguousarray(light),
            np.clip(albedo, 0.0, 1.0),
            normals,
            hdr=True,
            clean_aux=True,
        )
        return np.asarray(found, dtype=np.float32)


def _encoded(linear: Floats | Singles) -> Any:
    """Linear light as sRGB, 8 bits: what is brighter than white is white."""
    return np.round(srgb_from_linear(np.clip(linear, 0.0, 1.0).astype(np.float64)) * 255).astype(
        np.uint8
    )
