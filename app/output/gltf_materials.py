"""Materials as glTF says them: metallic and rough, and what its extensions add.

Glass is said twice. Viewers that know KHR_materials_transmission bend light through it; to others
it is a tinted film. It is blended for all of them: most of those that bend light through glass show
no glass behind glass, and a tube must not vanish. So half of what is seen comes straight through,
and half bent: the film has the root of its opacity. And as light is tinted both by the surface and
on its way through, each takes the root of the colour.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from pydantic_core import to_json

from app.scene.scene import Material, TextureName
from app.scene.textures import tint
from app.solids.mesh import Mesh

CLEARCOAT = "KHR_materials_clearcoat"
IOR = "KHR_materials_ior"
TRANSMISSION = "KHR_materials_transmission"
UNLIT = "KHR_materials_unlit"
VOLUME = "KHR_materials_volume"

_USUAL_IOR = 1.5  # which a viewer assumes


@dataclass(frozen=True, slots=True)
class Depth:
    """How far light goes through a thing on the average: in the world, and as its node is scaled.

    glTF wants the way on which it is tinted in the former, and thickness in the latter.
    """

    distance: float
    scale: float = 1.0


def material_text(
    material: Material, depth: Depth | None, textures: Mapping[TextureName, int]
) -> bytes:
    """The JSON text of a material, on something of that ``depth`` if light goes through it."""
    color, opacity = material.base_color[:3], material.base_color[3]
    if material.texture is not None:
        color = tint(color)
    if material.transmission > 0:
        opacity = sqrt(opacity)
        if depth:
            color = _root(color)
    surface: dict[str, Any] = {
        "baseColorFactor": (*color, opacity),
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    }
    if material.texture is not None:
        surface["baseColorTexture"] = {"index": textures[material.texture]}
    found: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": surface}
    if opacity < 1.0:
        found["alphaMode"] = "BLEND"
    extensions = _extensions(material, depth)
    if extensions:
        found["extensions"] = extensions
    return to_json(found)


def extensions_of(material: Material, depth: Depth | None) -> list[str]:
    """Names of the extensions that the material's text uses."""
    return list(_extensions(material, depth))


def chord_of(mesh: Mesh) -> float:
    """How far light goes through a closed mesh on the average, to two digits; 0 if it is flat.

    Four times its volume, of its surface (Cauchy's mean chord): a sheet of glass has twice its
    thickness, a rod its diameter, a ball two thirds of its own.
    """
    corners = mesh.vertices.astype(np.float64)[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    surface = float(np.linalg.norm(normals, axis=1).sum()) / 2
    volume = abs(float(np.einsum("ij,ij->", corners[:, 0], normals))) / 6
    return float(f"{4 * volume / surface:.2g}") if surface > 0 else 0.0


def _root(color: tuple[float, float, float]) -> tuple[float, float, float]:
    red, green, blue = color
    return sqrt(red), sqrt(green), sqrt(blue)


def _extensions(material: Material, depth: Depth | None) -> dict[str, Any]:
    if not material.is_lit:
        return {UNLIT: {}}
    found: dict[str, Any] = {}
    if material.transmission > 0:
        found[TRANSMISSION] = {"transmissionFactor": material.transmission}
        if depth:
            found[VOLUME] = {
                "thicknessFactor": depth.distance / depth.scale,
                "attenuationDistance": depth.distance,
                "attenuationColor": _root(material.base_color[:3]),
            }
        if material.ior != _USUAL_IOR:
            found[IOR] = {"ior": material.ior}
    if material.clearcoat > 0:
        found[CLEARCOAT] = {
            "clearcoatFactor": material.clearcoat,
            "clearcoatRoughnessFactor": material.clearcoat_roughness,
        }
    return found
