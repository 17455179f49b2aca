"""A scene as glTF's JSON document: everything but the buffer.

What there is once for each hyperedge is put together as text: many thousand small dictionaries
would take several times as long.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from pydantic_core import to_json

from app import __version__
from app.output.gltf_materials import extensions_of, material_text
from app.output.gltf_packing import Packed, PackedNode, Packing, pack
from app.output.gltf_textures import MEDIA_TYPE
from app.output.gltf_views import MESHOPT
from app.scene.camera import Axes, axes_from
from app.scene.rotation import quaternion
from app.scene.scene import Camera, Light, Scene

LIGHTS = "KHR_lights_punctual"

# A quarter turn about x: our z up becomes glTF's y up.
_Y_UP = [-sqrt(0.5), 0.0, 0.0, sqrt(0.5)]

_NOWHERE, _UPRIGHT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Document:
    """The JSON document in two parts, and what belongs into its buffer.

    ``json`` is whole but for ``buffers`` and for the entries of ``tables``, which are JSON texts.
    """

    json: dict[str, Any]
    tables: dict[str, list[bytes]]
    packed: Packed

    def text(self, buffer: bytes = b"") -> bytes:
        """The JSON text. ``buffer`` is what to say of the buffer besides its length."""
        pieces = [to_json(self.json, inf_nan_mode="null")[:-1]]
        pieces += [
            b',"%b":[%b]' % (name.encode(), b",".join(entries))
            for name, entries in self.tables.items()
            if entries  # glTF has no empty lists
        ]
        stored = self.packed.buffer
        if stored.length:
            pieces.append(b',"buffers":[{"byteLength":%d' % stored.length)
            pieces += [buffer, b"}"]
            if stored.fallback:
                # What encoded views are read into; there is nothing to be loaded instead.
                pieces.append(
                    b',{"byteLength":%d,"extensions":{"%b":{"fallback":true}}}'
                    % (stored.fallback, MESHOPT.encode())
                )
            pieces.append(b"]")
        return b"".join([*pieces, b"}"])


def describe(scene: Scene, packing: Packing) -> Document:
    """One root node that turns z up to y up; below it all of the scene, its lights and camera."""
    packed = pack(scene, packing)
    shown = _Shown(packed)

    nodes = [shown.node(node) for node in packed.nodes]
    nodes += [
        {
            "name": f"{light.name} light",
            "rotation": _rotation(axes_from(_opposite(light.direction))),
            "extensions": {LIGHTS: {"light": number}},
        }
        for number, light in enumerate(scene.lights)
    ]
    nodes.append(_camera_node(scene.camera))
    root = {
        "name": scene.name or "program",
        "rotation": _Y_UP,
        "children": list(range(1, len(nodes) + 1)),
    }
    described: dict[str, Any] = {"name": root["name"], "nodes": [0]}
    if scene.extras:
        described["extras"] = scene.extras
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"Tubeloom {__version__}"},
        "scene": 0,
        "scenes": [described],
        "nodes": [root, *nodes],
        "cameras": [_camera(scene.camera)],
    }
    extensions = packed.extensions | dict(sorted(shown.extensions.items()))
    if scene.lights:
        extensions[LIGHTS] = False
        document["extensions"] = {LIGHTS: {"lights": [_light(light) for light in scene.lights]}}
    if extensions:
        document["extensionsUsed"] = list(extensions)
    required = [name for name, is_required in extensions.items() if is_required]
    if required:
        document["extensionsRequired"] = required
    if packed.textures:
        document["images"] = [
            {"name": name, "bufferView": view, "mimeType": MEDIA_TYPE}
            for name, view in packed.textures.items()
        ]
        document["textures"] = [{"source": number} for number in range(len(packed.textures))]
    if packed.buffer.views:
        document["bufferViews"] = packed.buffer.views
    tables = {
        "materials": shown.materials,
        "meshes": shown.meshes,
        "accessors": packed.accessors,
    }
    return Document(document, tables, packed)


class _Shown:
    """Meshes and materials in the order in which nodes first show them, each only once."""

    def __init__(self, packed: Packed) -> None:
        self.materials: list[bytes] = []
        self.meshes: list[bytes] = []
        self.extensions: dict[str, bool] = {}
        self._packed = packed
        self._textures = {name: number for number, name in enumerate(packed.textures)}
        self._material_numbers: dict[int, int] = {}
        self._mesh_numbers: dict[tuple[tuple[int, int], ...], int] = {}

    def node(self, node: PackedNode) -> dict[str, Any]:
        """A node with its mesh; what is as glTF assumes it anyway is left out."""
        found: dict[str, Any] = {"name": node.name}
        if node.parts:
            number = self._mesh_numbers.setdefault(node.parts, len(self.meshes))
            if number == len(self.meshes):
                self.meshes.append(self._mesh(node.parts))
            found["mesh"] = number
        if node.translation != _NOWHERE:
            found["translation"] = node.translation
        if node.rotation != _UPRIGHT:
            found["rotation"] = node.rotation
        if node.scale != 1.0:
            found["scale"] = [node.scale] * 3
        if node.extras:
            found["extras"] = node.extras
        return found

    def _mesh(self, parts: tuple[tuple[int, int], ...]) -> bytes:
        primitives = [
            b'{%b,"material":%d}' % (self._packed.primitives[place], self._material(material))
            for place, material in parts
        ]
        return b'{"primitives":[%b]}' % b",".join(primitives)

    def _material(self, number: int) -> int:
        found = self._material_numbers.setdefault(number, len(self.materials))
        if found == len(self.materials):
            material, depth = self._packed.materials[number], self._packed.depths.get(number)
            self.materials.append(material_text(material, depth, self._textures))
            self.extensions |= dict.fromkeys(extensions_of(material, depth), False)
        return found


def _light(light: Light) -> dict[str, Any]:
    return {
        "name": light.name,
        "type": "directional",
        "color": light.color,
        "intensity": light.illuminance,
    }


def _camera(camera: Camera) -> dict[str, Any]:
    depth = {"znear": camera.near, "zfar": camera.far}
    if camera.vertical_angle is not None:
        lens = {"aspectRatio": camera.aspect, "yfov": camera.vertical_angle}
        return {"name": "camera", "type": "perspective", "perspective": lens | depth}
    if camera.height is None:
        raise ValueError("A camera needs an angle or a height.")
    lens = {"xmag": camera.height * camera.aspect / 2, "ymag": camera.height / 2}
    return {"name": "camera", "type": "orthographic", "orthographic": lens | depth}


def _camera_node(camera: Camera) -> dict[str, Any]:
    back = np.subtract(camera.position, camera.target)
    back = back / np.linalg.norm(back)
    right = np.cross(camera.up, back)
    right = right / np.linalg.norm(right)
    return {
        "name": "camera",
        "camera": 0,
        "translation": camera.position,
        "rotation": _rotation(Axes(right, np.cross(back, right), back)),
    }


def _rotation(axes: Axes) -> tuple[float, float, float, float]:
    """The rotation of what looks, or shines, along its own -z, with y up."""
    return quaternion(np.stack([axes.right, axes.up, axes.back], axis=1))


def _opposite(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = vector
    return -x, -y, -z
