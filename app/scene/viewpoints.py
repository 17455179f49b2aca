"""Named views of a scene, for a contact sheet."""

from __future__ import annotations

from types import MappingProxyType

from app.scene.camera import frame
from app.scene.framing import farthest_of, ground_of, vertices_of, view_of
from app.scene.scene import Camera, Scene

SIDES = MappingProxyType(
    {
        # Not from quite as low as the ground, where things hide each other and tubes are but lines.
        "Front": (0.0, -1.0, 0.3),
        "Right": (1.0, 0.0, 0.3),
        "Back": (0.0, 1.0, 0.3),
        "Left": (-1.0, 0.0, 0.3),
        "Top": (0.0, 0.0, 1.0),
    }
)
"""Directions from the scene to the camera."""


def viewpoints(scene: Scene) -> tuple[tuple[str, Camera], ...]:
    """The scene's own view, and the scene from each of `SIDES`; each as the own one is framed."""
    vertices = vertices_of(scene)
    own = view_of(scene, vertices)
    farthest = farthest_of(vertices) if len(vertices) else None
    ground = ground_of(scene)
    cameras = [("As chosen", scene.camera)]
    for name, direction in SIDES.items():
        view = own.model_copy(update={"from_": direction})
        cameras.append((name, frame(farthest, view, scene.camera.aspect, ground)))
    return tuple(cameras)
