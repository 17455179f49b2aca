"""How a scene is framed: what its camera wishes for, and what of it other cameras must see."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats
from app.placement.turning import matrices
from app.program.model import View
from app.scene.camera import Farthest, axes_from
from app.scene.scene import Camera, Node, Scene

_CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])


def vertices_of(scene: Scene) -> Floats:
    """All there is to frame, in the world, (v, 3): vertices, and the corners around a crowd.

    The ground is not framed. An empty scene has no vertices.
    """
    found = _vertices([node for node in scene.nodes if node.shows != "ground"])
    if scene.crowd is None:
        return found
    corners = scene.crowd.boxes[:, _CORNERS, [0, 1, 2]].reshape(-1, 3)
    return np.concatenate([found, corners])


def ground_of(scene: Scene) -> Farthest | None:
    """How far the ground reaches; ``None`` where there is none."""
    vertices = _vertices([node for node in scene.nodes if node.shows == "ground"])
    return farthest_of(vertices) if len(vertices) else None


def farthest_of(vertices: Floats) -> Farthest:
    """Answers which of the vertices (v, 3) lies farthest along a direction."""
    return lambda direction: vertices[int(np.argmax(vertices @ direction))]


def view_of(scene: Scene, vertices: Floats) -> View:
    """The wishes that the scene's own camera was framed by."""
    camera = scene.camera
    back = np.subtract(camera.position, camera.target)
    x, y, z = (back / np.linalg.norm(back)).tolist()
    angle = 30.0 if camera.vertical_angle is None else float(np.degrees(camera.vertical_angle))
    widest = float(np.abs(_seen(camera, vertices)).max(initial=0.0)) or 1.0
    return View(
        projection="orthographic" if camera.vertical_angle is None else "perspective",
        from_=(x, y, z),
        field_of_view=min(max(angle, 1.0), 120.0),
        margin=min(max((1 - widest) / 2, 0.0), 0.45),
    )


def _vertices(nodes: Sequence[Node]) -> Floats:
    solid = [node for node in nodes if node.primitives]
    if not solid:
        return np.zeros((0, 3))
    rotations = matrices(np.array([node.rotation for node in solid]))
    return np.concatenate(
        [
            part.mesh.vertices @ rotation.T + node.translation
            for node, rotation in zip(solid, rotations, strict=True)
            for part in node.primitives
        ]
    )


def _seen(camera: Camera, vertices: Floats) -> Floats:
    """Where vertices (v, 3) are in the picture, (v, 2): -1 to 1 to the right and up."""
    away = vertices - camera.position
    axes = axes_from(_triple(np.subtract(camera.position, camera.target)))
    if camera.vertical_angle is None:
        half = np.full(len(vertices), (camera.height or 1.0) / 2)
    else:
        half = -(away @ axes.back) * float(np.tan(camera.vertical_angle / 2))
    return np.stack([away @ axes.right / (half * camera.aspect), away @ axes.up / half], axis=1)


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
