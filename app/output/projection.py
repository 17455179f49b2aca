"""From the world to places in a picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.scene.scene import Camera


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """What a camera shows in ``width`` by ``height`` pixels; y runs down.

    ``axes`` (3, 3) are right, up and toward the camera, as rows.
    """

    axes: Floats
    position: Floats
    scale: float
    is_perspective: bool
    width: int
    height: int

    @staticmethod
    def of(camera: Camera, width: int, height: int) -> Projection:
        """The projection of a camera."""
        position = np.array(camera.position, dtype=np.float64)
        back = position - camera.target
        back /= np.linalg.norm(back)
        right = np.cross(camera.up, back)
        right /= np.linalg.norm(right)
        axes = np.array([right, np.cross(back, right), back])
        if camera.vertical_angle is not None:
            scale = height / 2 / float(np.tan(camera.vertical_angle / 2))
            return Projection(axes, position, scale, True, width, height)
        return Projection(axes, position, height / (camera.height or 1.0), False, width, height)

    def __call__(self, points: Floats) -> Floats:
        """Pixels to the right and down, and the distance along the viewing axis, of (…, 3)."""
        away = (points - self.position) @ self.axes.T
        depth = -away[..., 2]
        scale = self.scales(depth)
        x = self.width / 2 + away[..., 0] * scale
        y = self.height / 2 - away[..., 1] * scale
        return np.stack([x, y, depth], axis=-1)

    def scales(self, depths: Floats) -> Floats:
        """Pixels to a unit at distances along the viewing axis."""
        if self.is_perspective:
            return np.asarray(self.scale / np.maximum(depths, 1e-9))
        return np.full(np.shape(depths), self.scale)

    def sees_front(self, points: Floats, normals: Floats) -> Floats:
        """Positive where a surface at (n, 3) with ``normals`` (n, 3) faces the camera."""
        toward = self.position - points if self.is_perspective else self.axes[2]
        return np.asarray((normals * toward).sum(axis=-1))
