"""glTF that moves: the scene on a turntable, or the camera in flight."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from app.arrays import Floats
from app.output.gltf_document import LIGHTS, Document, describe
from app.output.gltf_packing import Packing
from app.output.media import Motion
from app.scene.motion import axis_of, cameras_of
from app.scene.rotation import quaternion
from app.scene.scene import Camera, Scene

EIGHTHS = 8
"""Of a turn, between which viewers turn evenly: their way from one rotation to the next is the
shorter one, so each must be less than half a turn."""

FLIGHT_KEYS = 72

_FLOAT = 5126  # by OpenGL's numbers

Path: TypeAlias = Literal["translation", "rotation"]


@dataclass(frozen=True, slots=True)
class Animation:
    """A motion that takes so many seconds and then begins anew."""

    motion: Motion
    seconds: float


@dataclass(frozen=True, slots=True, eq=False)
class _Channel:
    """What of a node moves: ``values`` (k, 3) or quaternions (k, 4) at its keys."""

    node: int
    path: Path
    values: NDArray[np.float32]


def describe_moving(scene: Scene, packing: Packing, animation: Animation) -> Document:
    """As `describe`, with an animation.

    On a turntable the scene turns before a camera that sees all of it at any time; light, camera
    and ground stay. In flight the camera moves; an orthographic one does not come nearer, as
    glTF's have one size.
    """
    if animation.motion == "turntable":
        (camera,) = cameras_of(scene, "turntable", 1)
        document = describe(replace(scene, camera=camera), packing)
        channels = _turning(document.json["nodes"], axis_of(scene))
    else:
        cameras = cameras_of(scene, "flight", FLIGHT_KEYS)
        depth = min(camera.near for camera in cameras), max(camera.far for camera in cameras)
        own = replace(scene.camera, near=depth[0], far=depth[1])
        document = describe(replace(scene, camera=own), packing)
        channels = _flying(document.json["nodes"], (*cameras, cameras[0]))
    return _with_animation(document, animation, channels) if channels else document


def _turning(nodes: list[dict[str, Any]], axis: Floats) -> list[_Channel]:
    """Puts all that turns below a node that does; an animation's pivot is its node's origin."""
    root = nodes[0]
    turning = [child for child in root["children"] if not _stays(nodes[child])]
    if not turning:
        return []
    pivot = len(nodes)
    staying = [child for child in root["children"] if _stays(nodes[child])]
    root["children"] = [pivot, *staying]
    nodes += [
        {"name": "turntable", "translation": axis.tolist(), "children": [pivot + 1]},
        {"name": "turned", "translation": (0.0 - axis).tolist(), "children": turning},
    ]
    # The film's camera goes round to the right: the same is to be seen where the scene turns left.
    halves = -np.pi * np.arange(EIGHTHS + 1) / EIGHTHS
    nothing = np.zeros_like(halves)
    turns = np.stack([nothing, nothing, np.sin(halves), np.cos(halves)], axis=1)
    return [_Channel(pivot, "rotation", turns.astype(np.float32))]


def _stays(node: dict[str, Any]) -> bool:
    return (
        "camera" in node
        or LIGHTS in node.get("extensions", {})
        or node.get("extras", {}).get("shows") == "ground"
    )


def _flying(nodes: list[dict[str, Any]], cameras: tuple[Camera, ...]) -> list[_Channel]:
    node = next(number for number, node in enumerate(nodes) if "camera" in node)
    positions = np.array([camera.position for camera in cameras], dtype=np.float32)
    rotations = np.array([_rotation(camera) for camera in cameras])
    # Of the two quaternions of a rotation, that which is nearer to the one before.
    signs = np.where((rotations[1:] * rotations[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    rotations[1:] *= np.cumprod(signs)[:, None]
    return [
        _Channel(node, "translation", positions),
        _Channel(node, "rotation", rotations.astype(np.float32)),
    ]


def _rotation(camera: Camera) -> tuple[float, float, float, float]:
    back = np.subtract(camera.position, camera.target)
    back = back / np.linalg.norm(back)
    right = np.cross(camera.up, back)
    return quaternion(np.stack([right, np.cross(back, right), back], axis=1))


def _with_animation(document: Document, animation: Animation, channels: list[_Channel]) -> Document:
    """The document with keys at even times in views at the end of its buffer."""
    keys = len(channels[0].values)
    times = np.linspace(0.0, animation.seconds, keys, dtype=np.float32)
    laid = document.packed.buffer
    views, pieces, length = list(laid.views), list(laid.pieces), laid.length
    accessors = list(document.tables["accessors"])
    for rows in (times, *(channel.values for channel in channels)):
        accessor: dict[str, Any] = {
            "bufferView": len(views),
            "componentType": _FLOAT,
            "count": keys,
            "type": "SCALAR" if rows.ndim == 1 else f"VEC{rows.shape[1]}",
        }
        if rows.ndim == 1:
            accessor |= {"min": [float(rows[0])], "max": [float(rows[-1])]}
        accessors.append(to_json(accessor))
        views.append({"buffer": 0, "byteOffset": length, "byteLength": rows.nbytes})
        pieces.append(np.ascontiguousarray(rows))
        length += rows.nbytes
    first = len(accessors) - 1 - len(channels)
    told = {
        "name": animation.motion,
        "samplers": [
            {"input": first, "output": first + number, "interpolation": "LINEAR"}
            for number in range(1, len(channels) + 1)
        ],
        "channels": [
            {"sampler": number, "target": {"node": channel.node, "path": channel.path}}
            for number, channel in enumerate(channels)
        ],
    }
    json = document.json | {"bufferViews": views, "animations": [told]}
    packed = replace(
        document.packed, buffer=replace(laid, views=views, pieces=pieces, length=length)
    )
    return Document(json, document.tables | {"accessors": accessors}, packed)
