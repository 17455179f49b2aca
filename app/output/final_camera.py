"""Cameras of the scene as Mitsuba's, and the lengths that it draws well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from app.arrays import Floats, Singles
from app.scene.scene import Camera

REACH = 10.0
"""Half the diagonal of what is drawn. Mitsuba starts rays 1.8e-4 · (1 + largest coordinate) off a
surface: it wants scenes neither much smaller, nor far from the origin."""

LOWEST = 0.02
"""Sine of the angle above the horizon from which on the ground is seen."""

Window = tuple[int, int, int, int]
"""Part of a picture in pixels: left, top, width, height."""


@dataclass(frozen=True, slots=True, eq=False)
class Measure:
    """From document units to what is drawn: about ``middle`` (3,), times ``scale``."""

    middle: Floats
    scale: float

    @staticmethod
    def of(bounds: Floats) -> Measure:
        """Fits ``bounds`` (2, 3) around the origin."""
        diagonal = float(np.linalg.norm(bounds[1] - bounds[0]))
        return Measure(bounds.mean(axis=0), 2 * REACH / diagonal if diagonal > 0 else 1.0)

    def place(self, points: Floats) -> Floats:
        """Where ``points`` (…, 3) are drawn."""
        return np.asarray((points - self.middle) * self.scale)

    def place_singles(self, points: Singles) -> Singles:
        """The same of many."""
        return np.asarray(self.place(points.astype(np.float64)), dtype=np.float32)


def sees_ground(camera: Camera, floor: float) -> bool:
    """Whether a camera looks at a ground at height ``floor`` from above."""
    back = np.subtract(camera.position, camera.target)
    if camera.vertical_angle is None:
        return bool(back[2] > LOWEST * np.linalg.norm(back))
    return camera.position[2] > floor


def sensor(
    renderer: Any, camera: Camera, measure: Measure, size: tuple[int, int], window: Window
) -> Any:
    """A camera for pictures of ``size``, which draws only ``window``."""
    position, target = measure.place(np.array([camera.position, camera.target]))
    up = _up(camera)
    parts: dict[str, Any] = {
        "near_clip": camera.near * measure.scale,
        "far_clip": 1e6,
        "film": _film(size, window),
        "sampler": {"type": "multijitter"},
    }
    shift = np.array(camera.shift)
    transform = renderer.ScalarTransform4f()
    if camera.vertical_angle is not None:
        parts |= {
            "type": "perspective",
            "fov_axis": "y",
            "fov": float(np.degrees(camera.vertical_angle)),
            "principal_point_offset_x": float(shift[0] / 2),
            "principal_point_offset_y": float(-shift[1] / 2),
        }
        scaling = transform
    else:
        height = (camera.height or 1.0) * measure.scale
        halves = np.array([height * size[0] / size[1], height]) / 2
        back = (position - target) / np.linalg.norm(position - target)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        across = (shift * halves) @ np.array([right, np.cross(back, right)])
        away = _above_ground(back, halves[1])
        position, target = position + across + away * back, target + across
        parts["type"] = "orthographic"
        parts["near_clip"] += away
        scaling = transform.scale([halves[0], halves[0], 1.0])
    look = transform.look_at(origin=position.tolist(), target=target.tolist(), up=up.tolist())
    return renderer.load_dict({**parts, "to_world": look @ scaling})


def _above_ground(back: Floats, half: float) -> float:
    """How far an orthographic camera steps back, lest the lower part of it be under the ground."""
    return float((half + REACH) / back[2]) if back[2] > LOWEST else 0.0


def _film(size: tuple[int, int], window: Window) -> dict[str, Any]:
    left, top, width, height = window
    return {
        "type": "hdrfilm",
        "width": size[0],
        "height": size[1],
        "crop_offset_x": left,
        "crop_offset_y": top,
        "crop_width": width,
        "crop_height": height,
        "rfilter": {"type": "box"},
        "pixel_format": "rgba",
        "component_format": "float32",
    }


def _up(camera: Camera) -> Floats:
    """Any other, where a camera looks along its own."""
    away = np.subtract(camera.target, camera.position)
    aside = np.linalg.norm(np.cross(away, camera.up))
    up = np.array(camera.up, dtype=np.float64)
    return up if aside > 1e-9 * np.linalg.norm(away) else np.roll(up, 1)
