"""Materials: names that documents use, and how such surfaces answer to light.

The one table that every output maps from.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from app.arrays import Floats
from app.program.model import Finish, MaterialName
from app.scene.color import linear_of, srgb_of
from app.scene.scene import Material, TextureName


@dataclass(frozen=True, slots=True)
class Surface:
    """A kind of surface in any colour, with numbers from 0 to 1 as in glTF.

    ``roughness`` is by finish; ``usual_finish`` is the one that it has where none is asked for.
    ``opacity`` is for outputs that cannot refract, ``transmission`` for those that can.
    ``natural_color`` is that of items for which nobody chose one.
    """

    name: MaterialName
    title: str
    description: str
    roughness: Mapping[Finish, float]
    usual_finish: Finish
    metallic: float = 0.0
    opacity: float = 1.0
    transmission: float = 0.0
    ior: float = 1.5
    clearcoat: float = 0.0
    texture: TextureName | None = None
    natural_color: str | None = None
    is_lit: bool = True


SURFACES: Mapping[MaterialName, Surface] = {
    surface.name: surface
    for surface in (
        Surface(
            name="plastic",
            title="Plastic",
            description="Smooth, with soft highlights.",
            roughness={"shiny": 0.12, "satin": 0.3, "matte": 0.65},
            usual_finish="satin",
        ),
        Surface(
            name="metal",
            title="Metal",
            description="Tinted metal; shiny, it is nearly a mirror.",
            roughness={"shiny": 0.15, "satin": 0.37, "matte": 0.6},
            usual_finish="satin",
            metallic=1.0,
        ),
        Surface(
            name="glass",
            title="Glass",
            description="Clear enough to look into, and tinted by its colour.",
            roughness={"shiny": 0.0, "satin": 0.12, "matte": 0.3},
            usual_finish="shiny",
            opacity=0.35,
            transmission=1.0,
        ),
        Surface(
            name="wood",
            title="Wood",
            description="Polished wood with its grain along the thing; a colour tints it.",
            roughness={"shiny": 0.25, "satin": 0.45, "matte": 0.85},
            usual_finish="satin",
            clearcoat=0.3,
            texture="wood",
            natural_color="#b98a5a",
        ),
        Surface(
            name="stone",
            title="Stone",
            description="Speckled stone; a colour tints it.",
            roughness={"shiny": 0.15, "satin": 0.4, "matte": 0.9},
            usual_finish="satin",
            texture="stone",
            natural_color="#b9b7b2",
        ),
        Surface(
            name="matte",
            title="Matte",
            description="Like paper or chalk.",
            roughness={"shiny": 0.5, "satin": 0.7, "matte": 0.9},
            usual_finish="matte",
        ),
        Surface(
            name="plain",
            title="Plain",
            description="Its colour and nothing else: no light, no shade.",
            roughness={"shiny": 1.0, "satin": 1.0, "matte": 1.0},
            usual_finish="matte",
            is_lit=False,
        ),
    )
}
"""All materials by name."""

CLEARCOAT_ROUGHNESS: Mapping[Finish, float] = {"shiny": 0.03, "satin": 0.15, "matte": 0.5}


@dataclass(frozen=True, slots=True)
class Look:
    """What a document or a notation says of a surface, apart from its colour.

    ``translucency`` is the share of light that passes, from 0 to 1.
    """

    material: MaterialName
    finish: Finish | None = None
    translucency: float | None = None


def make_material(look: Look | MaterialName, color: str) -> Material:
    """The material of a ``look`` in the sRGB colour ``#rgb`` or ``#rrggbb``.

    >>> make_material("matte", "#fff").name, make_material(Look("metal", "shiny"), "#fff").name
    ('matte #ffffff', 'shiny metal #ffffff')
    """
    return _make_material(look if isinstance(look, Look) else Look(look), color)


@lru_cache(maxsize=1024)
def _make_material(look: Look, color: str) -> Material:
    return make_materials([look], srgb_of(color)[None])[0]


def in_white(material: Material) -> Material:
    """The same surface without its colour; its name says only what it is made of.

    >>> in_white(make_material("glass", "#0af")).name
    'glass'
    """
    white = (1.0, 1.0, 1.0, material.base_color[3])
    return replace(material, name=material.name.rpartition(" ")[0], base_color=white)


def make_materials(looks: Sequence[Look], colors: Floats) -> list[Material]:
    """Materials of ``looks`` (m,), each in its sRGB colour of ``colors`` (m, 3)."""
    digits = np.round(colors * 255).astype(np.uint8).tobytes().hex()
    return [
        replace(
            white,
            name=f"{white.name} #{digits[6 * number : 6 * number + 6]}",
            base_color=(red, green, blue, white.base_color[3]),
        )
        for number, (white, (red, green, blue)) in enumerate(
            zip(map(_uncolored, looks), linear_of(colors).tolist(), strict=True)
        )
    ]


@lru_cache(maxsize=256)
def _uncolored(look: Look) -> Material:
    """The material in white, named without a colour."""
    surface = SURFACES[look.material]
    finish = look.finish or surface.usual_finish
    words: list[str] = [] if look.finish is None else [finish]
    opacity, transmission = surface.opacity, surface.transmission
    if look.translucency is not None:
        words.append(f"{look.translucency:.3g}")
        opacity = 1.0 - look.translucency
        if transmission:
            transmission = look.translucency
    return Material(
        " ".join([*words, surface.name]),
        (1.0, 1.0, 1.0, opacity),
        surface.metallic,
        surface.roughness[finish],
        surface=surface.name,
        transmission=transmission,
        ior=surface.ior,
        clearcoat=surface.clearcoat,
        clearcoat_roughness=CLEARCOAT_ROUGHNESS[finish],
        texture=surface.texture,
        is_lit=surface.is_lit,
    )
