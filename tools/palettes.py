"""Computes the palettes and writes them to `app/scene/palettes.json`.

`make palettes` runs it. What it needs is a development dependency: the service reads the file.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from colorspacious import cspace_convert
from numpy.typing import NDArray

TARGET = Path(__file__).parents[1] / "app/scene/palettes.json"

COUNT = 256

BASE = (
    "#4c7ddd",  # blue
    "#e8661c",  # vermilion
    "#36b892",  # teal
    "#eeb41a",  # amber
    "#6f35a6",  # purple
    "#c6467c",  # rose
    "#68c0ef",  # sky
    "#7a3c18",  # brown
)
"""Chosen by eye among what a search found that people with any colour vision can tell apart: most
programs have few hyperedges, and these should look well together."""

# Wong (2011), "Points of view: Color blindness", Nature Methods 8, 441. Black comes last, for a
# black tube has no shading.
OKABE_ITO = (
    "#e69f00",
    "#56b4e9",
    "#009e73",
    "#f0e442",
    "#0072b2",
    "#d55e00",
    "#cc79a7",
    "#000000",
)

# Of CAM02: leaves out what shades badly, which is near-white, near-black, grey and neon.
LIGHTNESS, CHROMA = (28, 72), (18, 66)

VISIONS = ((None, 1.0), ("deuteranomaly", 1.6), ("protanomaly", 1.6))
"""Who should tell the colours apart, and weights for distances: seen without red and green all
colours are nearer to each other, and would otherwise decide alone."""


def seen(srgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where sRGB colours (c, 3) are in CAM02-UCS for each kind of vision, weighted: (k, c, 3)."""
    views = []
    for kind, weight in VISIONS:
        view = srgb
        if kind is not None:
            space = {"name": "sRGB1+CVD", "cvd_type": kind, "severity": 100}
            view = np.clip(cspace_convert(srgb, space, "sRGB1"), 0, 1)
        views.append(weight * cspace_convert(view, "sRGB1", "CAM02-UCS"))
    return np.array(views)


def glasbey_colors(count: int, steps: int = 40) -> list[str]:
    """``BASE``, and then each colour the one farthest from all before (Glasbey et al. 2007).

    Candidates are a grid of ``steps`` cubed. The package of that name measures a palette that it
    extends in two spaces at once, and takes colours next to given ones; hence our own.
    """
    axis = np.linspace(0, 1, steps)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    lightness, chroma = cspace_convert(grid, "sRGB1", "JCh")[:, :2].T
    grid = grid[
        (lightness >= LIGHTNESS[0])
        & (lightness <= LIGHTNESS[1])
        & (chroma >= CHROMA[0])
        & (chroma <= CHROMA[1])
    ]
    candidates = seen(grid)
    base = np.array([list(bytes.fromhex(color[1:])) for color in BASE]) / 255
    free = np.full(len(grid), np.inf)
    for chosen in seen(base).transpose(1, 0, 2):
        free = np.minimum(free, _distances(candidates, chosen))
    names = list(BASE[:count])
    while len(names) < count:
        best = int(free.argmax())
        names.append("#" + np.round(grid[best] * 255).astype(np.uint8).tobytes().hex())
        free = np.minimum(free, _distances(candidates, candidates[:, best]))
    return names


def _distances(candidates: NDArray[np.float64], color: NDArray[np.float64]) -> NDArray[np.float64]:
    """From ``color`` (k, 3) to candidates (k, c, 3) for whoever sees the least of it: (c,)."""
    return np.asarray(np.linalg.norm(candidates - color[:, None], axis=2).min(axis=0))


def palettes() -> list[dict[str, Any]]:
    """All palettes, as they stand in the file."""
    return [
        {
            "name": "glasbey",
            "title": "Glasbey",
            "description": "256 colours, each as far as can be from those before it, also for "
            "people who confuse red and green.",
            "colors": glasbey_colors(COUNT),
        },
        {
            "name": "okabe-ito",
            "title": "Okabe and Ito",
            "description": "Eight colours that people with any colour vision can tell apart, from "
            "Masataka Okabe and Kei Ito.",
            "colors": list(OKABE_ITO),
        },
    ]


if __name__ == "__main__":
    TARGET.write_text(json.dumps(palettes(), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
