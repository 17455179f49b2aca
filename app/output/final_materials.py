"""The table of materials as Mitsuba's BSDFs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from app.arrays import Floats, Singles
from app.scene.color import linear_of
from app.scene.scene import Material, TextureName
from app.scene.textures import texture, tint

PAPER = 0.86
"""What white reflects: the ground reflects more, so that white things on it keep their shape."""

BRIGHTEST = 0.95
"""What the ground reflects where the background is white; the exposure makes up for it."""

TINT = 0.25
"""Power of a colour by which glass tints light that crosses its surface once."""

DULL = 0.8
"""Roughness from which on a surface has no highlight."""

SMOOTH = 0.02
"""Roughness up to which glass is clear."""


@dataclass(frozen=True, slots=True)
class Kind:
    """What surfaces have in common that can be drawn as one mesh, with colours at its vertices.

    ``color`` is set where it cannot be at the vertices: beside a texture.
    """

    surface: str
    metallic: float
    roughness: float
    clearcoat: float
    clearcoat_roughness: float
    transmission: float
    opacity: float
    ior: float
    is_lit: bool
    texture: TextureName | None = None
    color: tuple[float, float, float] | None = None

    @property
    def is_glass(self) -> bool:
        """Whether light goes through and is bent."""
        return self.transmission > 0.0

    @property
    def has_vertex_colors(self) -> bool:
        """Whether the mesh says what colour is where."""
        return self.texture is None

    @staticmethod
    def of(material: Material, has_coordinates: bool) -> Kind:
        """The kind of a material, on a mesh with or without places in a texture."""
        textured = material.texture if has_coordinates else None
        red, green, blue, opacity = material.base_color
        return Kind(
            surface=material.surface,
            metallic=material.metallic,
            roughness=material.roughness,
            clearcoat=material.clearcoat,
            clearcoat_roughness=material.clearcoat_roughness,
            transmission=material.transmission,
            opacity=1.0 if material.transmission else opacity,
            ior=material.ior,
            is_lit=material.is_lit,
            texture=textured,
            color=(red, green, blue) if textured else None,
        )


def vertex_color(kind: Kind, color: Floats) -> Floats:
    """What stands at the vertices of a surface of linear ``color`` (3,).

    Glass tints light each time that it comes in or goes out, which may be six times in a block.
    """
    if kind.is_glass:
        return np.asarray(np.clip(color, 0.0, 1.0) ** TINT)
    if not kind.is_lit:
        return color * BRIGHTEST
    return color if kind.metallic else color * PAPER


def bsdf(renderer: Any, kind: Kind) -> dict[str, Any]:
    """The surface of a kind, for ``renderer`` (Mitsuba)."""
    color = _texture(renderer, kind) if kind.texture else _AT_VERTICES
    found = _surface(kind, color)
    if kind.opacity < 1.0:
        return {"type": "mask", "opacity": kind.opacity, "below": found}
    return found


_AT_VERTICES = {"type": "mesh_attribute", "name": "vertex_color"}


def emitter(kind: Kind) -> dict[str, Any] | None:
    """What shines by itself: surfaces that are not lit show their colour."""
    return None if kind.is_lit else {"type": "area", "radiance": _AT_VERTICES}


def _surface(kind: Kind, color: dict[str, Any]) -> dict[str, Any]:
    if not kind.is_lit:
        return {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
    if kind.is_glass:
        return _glass(kind, color)
    if kind.roughness >= DULL and not kind.metallic and not kind.clearcoat:
        return {"type": "twosided", "below": {"type": "diffuse", "reflectance": color}}
    found: dict[str, Any] = {
        "type": "principled",
        "base_color": color,
        "roughness": max(kind.roughness, 0.05),
        "metallic": kind.metallic,
        "specular": 0.5,
    }
    if kind.clearcoat:
        found["clearcoat"] = kind.clearcoat
        found["clearcoat_gloss"] = 1.0 - kind.clearcoat_roughness
    return found


def _glass(kind: Kind, color: dict[str, Any]) -> dict[str, Any]:
    """Clear or frosted; where little light passes, part of it is like plastic."""
    found: dict[str, Any] = {
        "type": "dielectric",
        "int_ior": kind.ior,
        "specular_transmittance": color,
    }
    if kind.roughness > SMOOTH:
        found |= {"type": "roughdielectric", "distribution": "ggx", "alpha": kind.roughness**2}
    if kind.transmission >= 1.0:
        return found
    body = {"type": "principled", "base_color": color, "roughness": max(kind.roughness, 0.05)}
    milky = {"type": "twosided", "below": body}
    return {"type": "blendbsdf", "weight": kind.transmission, "milky": milky, "clear": found}


@lru_cache(maxsize=2)
def _pattern(name: TextureName) -> Singles:
    """A texture in linear light, (s, s, 3)."""
    levels = linear_of(np.arange(256) / 255.0).astype(np.float32)
    return np.asarray(levels[texture(name)])


def _texture(renderer: Any, kind: Kind) -> dict[str, Any]:
    if kind.texture is None or kind.color is None:
        raise ValueError("This kind has no texture.")
    color = vertex_color(kind, np.array(tint(kind.color))).astype(np.float32)
    return {
        "type": "bitmap",
        "data": renderer.TensorXf(_pattern(kind.texture) * color),
        "raw": True,
        "wrap_mode": "repeat",
    }
