"""Sampling in passes, so that work can be watched, limited, and looked at before its end."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from app.arrays import Singles
from app.output.effort import Effort
from app.output.final_scene import FinalScene, sensor
from app.scene.scene import Camera

Ending = Literal["samples", "time limit", "noise"]

PASSES = (1, 3, 4, 8)
"""Samples of the first passes, each spread evenly within itself; the last number comes again."""

TILE_PIXELS = 1 << 20
"""Drawn at once: more would not be quicker, and would take gigabytes."""

GUIDE_SAMPLES = 4
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
        """Standard error of the mean luminance over all pixels, in the range that is shown."""
        if self.passes < 2:
            return 1.0
        mean = np.clip(self.light[..., :3].mean(axis=2), 0.0, 1.0)
        spread = np.clip(self.squares / self.samples - mean * mean, 0.0, None)
        return float(np.sqrt(spread.mean() / (self.passes - 1)))


def passes_of(samples: int) -> Iterator[int]:
    """How many samples each pass takes, ``samples`` in all.

    >>> list(passes_of(22))
    [1, 3, 4, 8, 6]
    """
    left = samples
    for count in itertools.chain(PASSES, itertools.repeat(PASSES[-1])):
        if left <= 0:
            return
        yield min(count, left)
        left -= count


@dataclass(frozen=True, slots=True, eq=False)
class Sampler:
    """Takes samples of a scene from one camera."""

    renderer: Any
    scene: FinalScene
    camera: Camera
    width: int
    height: int

    def passes(
        self, effort: Effort, samples: int, began: float, told: Callable[[float], None]
    ) -> Iterator[Sampled]:
        """What has been gathered after each pass; the last one says why it is the last.

        ``began`` is when the clock (`time.monotonic`) started for a time limit. ``told`` hears the
        share of the samples that are taken.
        """
        shape = (self.height, self.width)
        found = Sampled(np.zeros((*shape, 4), np.float32), 0, np.zeros(shape, np.float32), 0)
        windows = list(self._windows())
        sensors = [
            sensor(self.renderer, self.camera, (self.width, self.height), window)
            for window in windows
        ]
        for number, count in enumerate(passes_of(samples)):
            started = time.monotonic()
            light = np.empty((*shape, 4), np.float32)
            for tile, (window, eye) in enumerate(zip(windows, sensors, strict=True)):
                left, top, width, height = window
                seed = _seed(effort.seed, number, tile)
                drawn = self.renderer.render(self.scene.world, sensor=eye, spp=count, seed=seed)
                light[top : top + height, left : left + width] = np.array(drawn)[..., :4]
                done = (found.samples + count * (tile + 1) / len(windows)) / samples
                told(min(done, 1.0))
            np.nan_to_num(light, copy=False, nan=0.0, posinf=0.0, neginf=0.0)
            self._add(found, light, count)
            took = time.monotonic() - started
            found.ending = self._ending(found, effort, samples, began, took / count)
            yield found
            if found.ending is not None:
                return

    def guides(self) -> tuple[Singles, Singles]:
        """Albedo and normals (height, width, 3) of what is seen first, nearly without noise."""
        integrator = self.renderer.load_dict({"type": "aov", "aovs": "a:albedo,n:sh_normal"})
        found = np.empty((self.height, self.width, 6), np.float32)
        for window in self._windows():
            left, top, width, height = window
            eye = sensor(self.renderer, self.camera, (self.width, self.height), window)
            drawn = self.renderer.render(
                self.scene.world, sensor=eye, integrator=integrator, spp=GUIDE_SAMPLES, seed=0
            )
            found[top : top + height, left : left + width] = np.array(drawn)[..., -6:]
        np.nan_to_num(found, copy=False)
        return np.ascontiguousarray(found[..., :3]), np.ascontiguousarray(found[..., 3:])

    def _add(self, found: Sampled, light: Singles, count: int) -> None:
        total = found.samples + count
        light[..., :3] *= self.scene.exposure
        found.light += (light - found.light) * np.float32(count / total)
        shown = np.clip(light[..., :3].mean(axis=2), 0.0, 1.0)
        found.squares += count * shown * shown
        found.samples = total
        found.passes += 1

    def _ending(
        self, found: Sampled, effort: Effort, samples: int, began: float, per_sample: float
    ) -> Ending | None:
        if found.samples >= samples:
            return "samples"
        if effort.noise is not None and found.passes > 2 and found.noise <= effort.noise:
            return "noise"
        if effort.time_limit is not None:
            following = PASSES[min(found.passes, len(PASSES) - 1)]
            spent = time.monotonic() - began
            if spent + following * per_sample > effort.time_limit:
                return "time limit"
        return None

    def _windows(self) -> Iterator[tuple[int, int, int, int]]:
        """Strips of the picture: left, top, width, height."""
        rows = max(1, min(self.height, TILE_PIXELS // self.width))
        strips = math.ceil(self.height / rows)
        edges = np.linspace(0, self.height, strips + 1).astype(int).tolist()
        for top, bottom in itertools.pairwise(edges):
            yield 0, top, self.width, bottom - top


def _seed(seed: int, number: int, tile: int) -> int:
    """Of one tile in one pass: no two are alike (Knuth's multiplicative hash)."""
    return (seed * 2654435761 + number * 40503 + tile * 2246822519 + 1) % (1 << 31)
