"""Flat tones: the colours of one surface by how it is turned to the light."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import Floats
from app.scene.color import hex_of, oklab_of, srgb_from_linear, srgb_from_oklab
from app.scene.scene import Material

LIGHT = np.array([-0.38, -0.3, 0.95])
"""Where it comes from: over the left shoulder of who looks from the front."""

LEVELS = (0.35, 0.55, 0.72, 0.88)
"""Brightness at which round surfaces change their tone."""

DEEPEST, HIGHEST = -0.21, 0.03
"""What is added to a colour's lightness (in Oklab) in no light and in all of it."""

_TOWARDS = LIGHT / np.linalg.norm(LIGHT)


@dataclass(frozen=True, slots=True)
class Shades:
    """The tones of a surface whose colour is ``base``, in Oklab."""

    base: tuple[float, float, float]
    is_lit: bool = True

    @staticmethod
    def of(material: Material) -> Shades:
        """Those of a material; what lets light through is paler."""
        return _of(material)

    @staticmethod
    def brightness(normals: Floats) -> Floats:
        """How bright surfaces are, 0 to 1, by their unit normals (…, 3)."""
        return np.asarray(0.5 + 0.5 * (normals @ _TOWARDS))

    def tone(self, brightness: float) -> str:
        """The colour at some brightness, as ``#rrggbb``."""
        if not self.is_lit:
            return self.lighter(0.0)
        return self.lighter(DEEPEST + (HIGHEST - DEEPEST) * brightness)

    @property
    def line(self) -> str:
        """The colour of lines on and around it."""
        return _shifted(self.base, -0.3, 0.75)

    def lighter(self, by: float) -> str:
        """The colour, its lightness changed."""
        return _shifted(self.base, by, 1.0)


@lru_cache(maxsize=1024)
def _of(material: Material) -> Shades:
    red, green, blue, opacity = material.base_color
    oklab = oklab_of(srgb_from_linear(np.array([red, green, blue])))
    if material.transmission or opacity < 1.0:
        oklab = oklab + 0.3 * (np.array([1.0, 0.0, 0.0]) - oklab)
    lightness, a, b = oklab.tolist()
    return Shades((lightness, a, b), material.is_lit)


@lru_cache(maxsize=4096)
def _shifted(base: tuple[float, float, float], by: float, chroma: float) -> str:
    lightness = min(max(base[0] + by, 0.12), 1.0)
    return hex_of(srgb_from_oklab(np.array([lightness, base[1] * chroma, base[2] * chroma])))
