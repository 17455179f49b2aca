"""From the world to the sheet: where a camera shows points, in pixels, and how near they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.scene.scene import Camera


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """A camera over a sheet of ``width`` by ``height`` pixels, y pointing down.

    ``eye`` (3,) is where it stands and ``axes`` (3, 3) are its unit vectors to the right, up and
    back. ``scale`` is how many pixels a unit takes: of perspective cameras at a depth of one.
    """

    eye: Floats
    axes: Floats
    middle: Floats
    scale: float
    near: float
    is_perspective: bool

    @staticmethod
    def of(camera: Camera, width: int, height: int) -> Projection:
        """The projection that fills the sheet. Raises `ValueError` for a camera without lens."""
        eye = np.array(camera.position)
        back = eye - np.array(camera.target)
        back /= np.linalg.norm(back)
        right = np.cross(np.array(camera.up), back)
        right /= np.linalg.norm(right)
        moved = np.array([-camera.shift[0], camera.shift[1]]) + 1.0
        if camera.vertical_angle is not None:
            scale = height / 2 / float(np.tan(camera.vertical_angle / 2))
        elif camera.height is not None:
            scale = height / camera.height
        else:
            raise ValueError("A camera needs an angle or a height.")
        return Projection(
            eye,
            np.array([right, np.cross(back, right), back]),
            moved * (width / 2, height / 2),
            scale,
            camera.near,
            camera.vertical_angle is not None,
        )

    def seen(self, points: Floats) -> Floats:
        """Points (…, 3) of the world as x, y (pixels) and nearness.

        Nearness is larger in front, and linear over the picture of a plane: what is one over the
        depth for perspective cameras is minus the depth for others.
        """
        found = np.asarray((points - self.eye) @ self.axes.T)
        depth = np.maximum(-found[..., 2], self.near)
        if self.is_perspective:
            found[..., :2] /= depth[..., None]
            found[..., 2] = 1.0 / depth
        else:
            found[..., 2] = -depth
        found[..., 0] = self.middle[0] + self.scale * found[..., 0]
        found[..., 1] = self.middle[1] - self.scale * found[..., 1]
        return found

    def sizes(self, nearness: Floats) -> Floats:
        """How many pixels a unit across the view takes, (…)."""
        return self.scale * nearness if self.is_perspective else np.full_like(nearness, self.scale)

    def nearer(self, nearness: Floats, by: Floats | float) -> Floats:
        """Nearness (…) of what is ``by`` document units nearer."""
        if not self.is_perspective:
            return nearness + by
        return np.asarray(1.0 / np.maximum(1.0 / nearness - by, self.near))

    def sight(self, points: Floats) -> Floats:
        """Vectors (…, 3), of any length, from points to the camera."""
        return (
            self.eye - points
            if self.is_perspective
            else np.broadcast_to(self.axes[2], points.shape)
        )
