"""The ground: a plain disc under the scene that catches its shadows."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from app.arrays import Floats
from app.scene.color import hex_of, oklab_of, srgb_from_oklab
from app.solids.mesh import Mesh

WIDTH = 4.0
"""Radius over the scene's: its rim is far from what there is to see."""

SIDES = 128

PAPER = np.array([0.93, 0.93, 0.93])
"""Where the background is transparent."""


DARKEST = 0.16
"""Lightness (in Oklab): what is black has no shadows."""


@lru_cache(maxsize=1)
def unit_disc() -> Mesh:
    """A disc of radius 1 around the origin that is seen from above only."""
    turn = np.arange(SIDES) * (2 * np.pi / SIDES)
    rim = np.stack([np.cos(turn), np.sin(turn), np.zeros(SIDES)], axis=1)
    vertices = np.vstack([np.zeros((1, 3)), rim]).astype(np.float32)
    numbers = np.arange(SIDES)
    faces = np.stack([np.zeros_like(numbers), numbers + 1, (numbers + 1) % SIDES + 1], axis=1)
    normals = np.tile(np.array([0, 0, 1], dtype=np.float32), (SIDES + 1, 1))
    return Mesh(vertices, normals, faces.astype(np.uint32))


def disc_below(bounds: Floats) -> tuple[Mesh, Floats]:
    """A ground under ``bounds`` (2, 3), and its centre (3,)."""
    low, high = bounds
    center = np.array([*(low[:2] + high[:2]) / 2, low[2]])
    radius = WIDTH * max(float(np.linalg.norm(high - low)) / 2, 1e-3)
    disc = unit_disc()
    return Mesh(disc.vertices * np.float32(radius), disc.normals, disc.faces), center


def ground_color(background: Floats | None) -> str:
    """A colour near the sRGB ``background`` (3,), so that the scene seems to stand on it."""
    if background is None:
        return hex_of(PAPER)
    oklab = oklab_of(background)
    lightness = float(oklab[0])
    oklab[0] = lightness - 0.03 if lightness > 0.5 else max(lightness + 0.05, DARKEST)
    return hex_of(srgb_from_oklab(oklab))
