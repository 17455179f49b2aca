"""Moving cameras: once around the scene, or a flight over it. Ground and lights stay."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, TypeAlias

import numpy as np

from app.arrays import Floats
from app.scene.camera import Farthest, frame
from app.scene.flight import flight
from app.scene.framing import ground_of, vertices_of, view_of
from app.scene.scene import Camera, Scene

Motion: TypeAlias = Literal["turntable", "flight"]


def cameras_of(scene: Scene, motion: Motion, frames: int) -> tuple[Camera, ...]:
    """A camera for each frame of a film that may begin anew after its last.

    A turntable goes once around the vertical axis through the scene's middle, from one distance
    that lets the whole scene be seen in every frame; `app.scene.flight` has the flight.
    """
    if motion == "flight":
        return flight(scene, frames)
    vertices = vertices_of(scene)
    view, axis = view_of(scene, vertices), axis_of(scene)
    whole = _turned_around(vertices, axis) if len(vertices) else None
    start = frame(whole, view, scene.camera.aspect, ground_of(scene))
    return tuple(_around(start, axis, turn) for turn in np.arange(frames) * (2 * np.pi / frames))


def axis_of(scene: Scene) -> Floats:
    """Where the axis of a turntable passes the scene's middle, (3,)."""
    return np.asarray(scene.bounds.mean(axis=0))


def _turned_around(vertices: Floats, axis: Floats) -> Farthest:
    """How far the vertices (v, 3) reach when turned around the vertical ``axis``: all the rings.

    Who sees these sees every vertex at any time.
    """
    away = vertices - axis
    radii, heights = np.hypot(away[:, 0], away[:, 1]), away[:, 2]

    def farthest(direction: Floats) -> Floats:
        flat = float(np.hypot(direction[0], direction[1]))
        ring = int(np.argmax(radii * flat + heights * direction[2]))
        heading = direction[:2] / flat if flat else np.array([1.0, 0.0])
        return np.asarray(axis + np.array([*(radii[ring] * heading), heights[ring]]))

    return farthest


def _around(camera: Camera, axis: Floats, turn: float) -> Camera:
    cosine, sine = np.cos(turn), np.sin(turn)
    rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    position, target = (
        axis + rotation @ (np.array(place) - axis) for place in (camera.position, camera.target)
    )
    return replace(
        camera,
        position=_triple(position),
        target=_triple(target),
        up=_triple(rotation @ camera.up),
    )


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
