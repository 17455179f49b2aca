"""Time of final pictures against their likeness (SSIM) to one of thousands of samples.

``python -m benchmarks.final_quality`` prints a table for each of the ID3 clauses. The reference is
the mean of two pictures of different seeds; how alike these two are is its own noise. Thousands of
samples take minutes for each 100,000 pixels: ``--width``, ``--height`` and ``--reference`` make it
less.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter
from tqdm import tqdm

from app.arrays import Floats
from app.formats import registry
from app.output.effort import Effort
from app.output.final import draw_final
from app.scene.scene import Scene
from app.settings import Settings
from app.staging import make_scene

EXAMPLES = Path(__file__).parents[1] / "examples"
DOCUMENTS = ("id3-clause-1", "id3-clause-2", "id3-clause-2-materials")
SAMPLES = (4, 8, 16, 32, 64, 128, 256)

WINDOW = 1.5
"""Standard deviation of the weights, in pixels (Wang and others 2004, section III.B)."""

STEADY = (0.01**2, 0.03**2)
"""What keeps the quotients of dark and of even places finite, brightness going to 1."""


def structural_similarity(one: Floats, other: Floats) -> float:
    """Mean SSIM of two pictures (height, width) from 0 to 1 (Wang and others 2004).

    >>> ramp = np.tile(np.linspace(0.0, 1.0, 32), (32, 1))
    >>> structural_similarity(ramp, ramp)
    1.0
    """

    def smooth(picture: Floats) -> Floats:
        return np.asarray(gaussian_filter(picture, WINDOW, truncate=3.5))

    mean, mean_other = smooth(one), smooth(other)
    spread = smooth(one * one) - mean * mean
    spread_other = smooth(other * other) - mean_other * mean_other
    shared = smooth(one * other) - mean * mean_other
    light, contrast = STEADY
    likeness = (2 * mean * mean_other + light) * (2 * shared + contrast)
    likeness /= (mean**2 + mean_other**2 + light) * (spread + spread_other + contrast)
    return float(likeness.mean())


def scene_of(name: str, width: int, height: int) -> Scene:
    """One of the `DOCUMENTS`, as a picture of that size shows it."""
    document = (EXAMPLES / f"{name}.json").read_bytes()
    program = registry.read("tubeloom", document, Settings())
    return make_scene(program, width / height, height=height)


def drawn(scene: Scene, width: int, height: int, effort: Effort) -> Floats:
    """Brightness (height, width) as a screen shows it, from 0 to 1."""
    picture = draw_final(scene, width, height, effort, lambda _stage, _share: None).picture
    return np.asarray(picture.convert("L"), dtype=np.float64) / 255.0


def rows(name: str, width: int, height: int, reference: int) -> list[str]:
    """The table of one document, as Markdown."""
    scene = scene_of(name, width, height)
    # Kernels are compiled for each scene, once in a process.
    drawn(scene, width, height, Effort(samples=8))
    halves = [
        drawn(scene, width, height, Effort(samples=reference // 2, denoise=False, seed=seed))
        for seed in (11, 12)
    ]
    best = (halves[0] + halves[1]) / 2
    own = structural_similarity(*halves)
    found = [
        (
            f"{name}, {width} by {height}: two halves of the reference ({reference:,} samples) are "
            f"alike by {own:.4f}."
        ),
        "",
        "| samples | seconds | SSIM | denoised: seconds | SSIM |",
        "|---|---|---|---|---|",
    ]
    for samples in tqdm(SAMPLES, desc=name, leave=False):
        cells = [str(samples)]
        for denoise in (False, True):
            began = time.monotonic()
            picture = drawn(scene, width, height, Effort(samples=samples, denoise=denoise))
            taken = time.monotonic() - began
            cells += [f"{taken:.2f}", f"{structural_similarity(picture, best):.4f}"]
        found.append(f"| {' | '.join(cells)} |")
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=480)
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("documents", nargs="*", default=DOCUMENTS)
    wishes = parser.parse_args(arguments)
    for name in wishes.documents:
        lines = rows(name, wishes.width, wishes.height, wishes.reference)
        print("\n".join(lines), end="\n\n", flush=True)


if __name__ == "__main__":
    main()
