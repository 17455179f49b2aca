"""Sampling in passes, so that work can be watched, limited, and looked at before its end."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any, Literal

import numpy as np

from app.arrays import Singles
from app.output.effort import Effort
from app.output.final_camera import Window, sensor
from app.output.final_guides import guide
from app.output.final_scene import FinalScene
from app.output.final_thread import wait_for
from app.scene.scene import Camera

Ending = Literal["samples", "time limit", "noise"]

PASS_SAMPLES = 16
"""Of each pixel in a pass at most. Those of one pass are spread evenly over all directions, those
of two passes are not: 16 at once are as free of noise as 27 by fours."""

FIRST_PASS_SAMPLES = 8
"""In the first two at most: who watches soon sees something."""

SHORT_PASS_SAMPLES = 4
"""Where time or noise may end the work before all samples are taken: so it ends in time."""

PASS_PIXELS = 12 << 20
"""Samples of all pixels in a pass, about: of a large picture a pass takes fewer of each."""

TILE_PIXELS = 1 << 20
"""Drawn at once: more would not be quicker, and would take gigabytes."""

BRIGHTEST_PIXEL = 6.0
"""What a pass may add to a pixel, white being 1: a single glint is not to make a spark."""

GUIDE_SAMPLES = 8
"""For what guides the denoiser: it costs little, since no light is followed."""


@dataclass(slots=True, eq=False)
class Sampled:
    """What has been gathered: means (height, width, …) of all passes.

    ``light`` is linear RGB and coverage (0 where the eye meets the sky).
    """

    light: Singles
    samples: int
    squares: Singles
    passes: int
    ending: Ending | None = None

    @property
    def noise(self) -> float:
        """Standard error of the mean brightness over all pixels, in the range that is shown.

        Of a single pass, too much: how much neighbours differ.
        """
        mean = self.light[..., :3].mean(axis=2)
        np.clip(mean, 0.0, 1.0, out=mean)
        if self.passes < 2:
            steps = np.diff(mean, axis=1)
            return float(np.sqrt((steps * steps).mean() / 2)) if steps.size else 1.0
        spread = np.clip(self.squares / self.samples - mean * mean, 0.0, None)
        return float(np.sqrt(spread.mean() / (self.passes - 1)))


@dataclass(frozen=True, slots=True, eq=False)
class Guides:
    """What denoising needs, and what is ground: (height, width, 3), twice, and (height, width).

    ``covered`` is how much of each pixel shows anything but ground and sky.
    """

    albedo: Singles
    normals: Singles
    covered: Singles


def passes_of(samples: int, pixels: int, most: int = PASS_SAMPLES) -> list[int]:
    """How many samples each pass takes, ``samples`` in all; two passes, lest noise be unknown.

    >>> passes_of(40, 640 * 480), passes_of(16, 640 * 480), passes_of(3, 4096 * 4096)
    ([8, 8, 16, 8], [8, 8], [1, 1, 1])
    """
    usual = max(1, min(most, PASS_PIXELS // pixels, samples // 2))
    first = min(usual, FIRST_PASS_SAMPLES)
    begun = [first] * min(2, samples // first)
    whole, rest = divmod(samples - sum(begun), usual)
    return begun + [usual] * whole + [rest] * (rest > 0)


@dataclass(frozen=True, slots=True, eq=False)
class Sampler:
    """Takes samples of a scene from one camera."""

    renderer: Any
    scene: FinalScene
    camera: Camera
    width: int
    height: int

    def passes(
        self, effort: Effort, samples: int, deadline: float, told: Callable[[float], None]
    ) -> Iterator[Sampled]:
        """What has been gathered after each pass; the last one says why it is the last.

        There should be no pass that ends after ``deadline`` (`time.monotonic`), if it is not the
        first. ``told`` hears the share of the samples that are taken.
        """
        shape = (self.height, self.width)
        found = Sampled(np.zeros((*shape, 4), np.float32), 0, np.zeros(shape, np.float32), 0)
        windows = list(self._windows())
        sensors = [self._sensor(window) for window in windows]
        is_open = effort.noise is not None or effort.time_limit is not None
        most = SHORT_PASS_SAMPLES if is_open else PASS_SAMPLES
        counts = passes_of(samples, self.width * self.height, most)
        for number, count in enumerate(counts):
            started = time.monotonic()
            for tile, (window, eye) in enumerate(zip(windows, sensors, strict=True)):
                done = found.samples + count * tile / len(windows)
                share, more = done / samples, count / len(windows) / samples
                drawn = wait_for(
                    self._drawing(eye, count, _seed(effort.seed, number, tile)),
                    _creeping(told, share, more),
                )
                self._add(found, window, drawn[..., :4], count)
                told(min(share + more, 1.0))
            found.samples += count
            found.passes += 1
            if number == len(counts) - 1:
                found.ending = "samples"
            elif effort.noise is not None and found.passes > 1 and found.noise <= effort.noise:
                found.ending = "noise"
            elif 2 * time.monotonic() - started > deadline:
                found.ending = "time limit"
            yield found
            if found.ending is not None:
                return

    def guides(self, alive: Callable[[], None]) -> Guides:
        """Albedo, normals and coverage, nearly without noise."""
        shape = (self.height, self.width)
        albedo, normals = (np.empty((*shape, 3), np.float32) for _ in range(2))
        covered = np.empty(shape, np.float32)
        for window in self._windows():
            place = _place(window)
            part = np.nan_to_num(wait_for(partial(self._guides, window), alive), copy=False)
            np.clip(part[..., :3], 0.0, 1.0, out=albedo[place])
            normals[place], covered[place] = part[..., 3:6], part[..., 6]
        return Guides(albedo, normals, covered)

    def _guides(self, window: Window) -> Singles:
        """Albedo, normals and coverage of a part of the picture, (height, width, 7)."""
        eye = self._sensor(window)
        found = np.zeros((window[3], window[2], 7), np.float32)
        draw = self.renderer.render
        seen = draw(
            self.scene.world,
            sensor=eye,
            integrator=guide(self.renderer, through_glass=self.scene.has_glass),
            spp=GUIDE_SAMPLES,
            seed=0,
        )
        found[..., :6] = np.array(seen)[..., -6:]
        if self.scene.things is not None:
            depth = self.renderer.load_dict({"type": "depth"})
            seen = draw(self.scene.things, sensor=eye, integrator=depth, spp=GUIDE_SAMPLES, seed=0)
            found[..., 6] = np.array(seen)[..., 3]
        return found

    def _drawing(self, eye: Any, count: int, seed: int) -> Callable[[], Singles]:
        return lambda: np.array(
            self.renderer.render(self.scene.world, sensor=eye, spp=count, seed=seed)
        )

    def _sensor(self, window: Window) -> Any:
        size = (self.width, self.height)
        return sensor(self.renderer, self.camera, self.scene.measure, size, window)

    def _add(self, found: Sampled, window: Window, light: Singles, count: int) -> None:
        """What a pass has drawn in a window; large pictures are never held twice."""
        np.nan_to_num(light, copy=False, nan=0.0, posinf=0.0, neginf=0.0)
        light[..., :3] *= self.scene.exposure
        np.minimum(light[..., :3], BRIGHTEST_PIXEL, out=light[..., :3])
        mean, squares = found.light[_place(window)], found.squares[_place(window)]
        mean += (light - mean) * np.float32(count / (found.samples + count))
        shown = np.clip(light[..., :3].mean(axis=2), 0.0, 1.0)
        squares += count * shown * shown

    def _windows(self) -> Iterator[Window]:
        """Strips of the picture."""
        rows = max(1, min(self.height, TILE_PIXELS // self.width))
        strips = math.ceil(self.height / rows)
        edges = np.linspace(0, self.height, strips + 1).astype(int).tolist()
        for top, bottom in itertools.pairwise(edges):
            yield 0, top, self.width, bottom - top


def _place(window: Window) -> tuple[slice, slice]:
    """Rows and columns of a window."""
    left, top, width, height = window
    return slice(top, top + height), slice(left, left + width)


def _creeping(told: Callable[[float], None], share: float, more: float) -> Callable[[], None]:
    """Tells ``share`` and a little more each time, never all of what is to come."""
    steps = itertools.count(1)
    return lambda: told(share + more * (1.0 - 0.9 ** next(steps)))


def _seed(seed: int, number: int, tile: int) -> int:
    """Of one tile in one pass: no two are alike (Knuth's multiplicative hash)."""
    return (seed * 2654435761 + number * 40503 + tile * 2246822519 + 1) % (1 << 31)
