"""Materials: names that documents use, and how such surfaces answer to light."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from app.arrays import Floats
from app.program.model import MaterialName
from app.scene.color import linear_of, srgb_of
from app.scene.scene import Material


@dataclass(frozen=True, slots=True)
class Surface:
    """A kind of surface in any colour: metallic, roughness and opacity as in glTF, 0 to 1."""

    name: str
    title: str
    description: str
    metallic: float
    roughness: float
    opacity: float


SURFACES: Mapping[MaterialName, Surface] = {
    "plastic": Surface(
        "plastic",
        "Plastic",
        "Smooth, with soft highlights.",
        metallic=0.0,
        roughness=0.3,
        opacity=1.0,
    ),
    "metal": Surface(
        "metal", "Metal", "Brushed metal, tinted.", metallic=1.0, roughness=0.37, opacity=1.0
    ),
    "glass": Surface(
        "glass", "Glass", "Clear enough to look into.", metallic=0.0, roughness=0.05, opacity=0.35
    ),
    "matte": Surface(
        "matte", "Matte", "Like paper or chalk.", metallic=0.0, roughness=0.9, opacity=1.0
    ),
}
"""All materials by name."""


@lru_cache(maxsize=1024)
def make_material(name: MaterialName, color: str) -> Material:
    """The material called ``name`` in the sRGB colour ``#rgb`` or ``#rrggbb``.

    >>> make_material("matte", "#fff")
    Material(name='matte #ffffff', base_color=(1.0, 1.0, 1.0, 1.0), metallic=0.0, roughness=0.9)
    """
    return make_materials([name], srgb_of(color)[None])[0]


def in_white(material: Material) -> Material:
    """The same surface without its colour; its name says only what it is made of.

    >>> in_white(make_material("glass", "#0af")).name
    'glass'
    """
    white = (1.0, 1.0, 1.0, material.base_color[3])
    return replace(material, name=material.name.partition(" ")[0], base_color=white)


def make_materials(names: Sequence[MaterialName], colors: Floats) -> list[Material]:
    """The materials called ``names`` (m,), each in its sRGB colour of ``colors`` (m, 3)."""
    digits = np.round(colors * 255).astype(np.uint8).tobytes().hex()
    surfaces = [SURFACES[name] for name in names]
    return [
        Material(
            f"{surface.name} #{digits[6 * number : 6 * number + 6]}",
            (red, green, blue, surface.opacity),
            surface.metallic,
            surface.roughness,
        )
        for number, (surface, (red, green, blue)) in enumerate(
            zip(surfaces, linear_of(colors).tolist(), strict=True)
        )
    ]
