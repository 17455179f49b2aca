"""Two cameras for two eyes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Floats
from app.scene.camera import Axes
from app.scene.scene import Camera

DEVIATION = 1 / 30
"""Of the picture's width: how far apart, at most, what is nearest and what is farthest may come to
lie from one eye to the other. More than this tires, so the usual rule of stereography."""

WIDEST = 1 / 15
"""Of the distance: two eyes before a screen. More does not make a flat scene deep."""

_CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])


def eyes(camera: Camera, bounds: Floats, distance: float | None) -> tuple[Camera, Camera]:
    """The left and the right eye in place of ``camera``, which looks at a scene in ``bounds``.

    They are ``distance`` apart, as a share of the distance to what the camera looks at: that is
    seen in the plane of the picture. Left out, `suitable` is taken. The eyes look in parallel, each
    picture shifted (off axis): turned eyes would see heights differently, which hurts.

    An orthographic camera has no place to see from; its eyes are turned instead, which changes no
    height there. The share is their angle.
    """
    back = np.subtract(camera.position, camera.target)
    away = float(np.linalg.norm(back))
    back /= away
    right = np.cross(camera.up, back)
    axes = Axes(right / np.linalg.norm(right), np.asarray(camera.up), back)
    share = suitable(camera, bounds) if distance is None else distance
    if camera.vertical_angle is None:
        return _turned(camera, bounds, axes, -share / 2), _turned(camera, bounds, axes, share / 2)
    half_width = float(np.tan(camera.vertical_angle / 2)) * camera.aspect

    def moved(side: float) -> Camera:
        step = side * share * away / 2 * axes.right
        return replace(
            camera,
            position=_triple(camera.position + step),
            target=_triple(camera.target + step),
            shift=(-side * share / 2 / half_width, 0.0),
        )

    return moved(-1.0), moved(1.0)


def suitable(camera: Camera, bounds: Floats) -> float:
    """The distance of the eyes, as a share of the distance, that suits the scene's depth.

    Bercovitz' formula (Bercovitz, J., Image-side perspective and stereoscopy, SPIE 3295, 1998)
    without the thickness of lenses: eyes b apart see the nearest (n) and the farthest (f) of a
    picture that is 2·t·d wide at d come apart by b·(1/n - 1/f)/2t of its width; that is to be
    `DEVIATION`, unless b would be more than `WIDEST`.
    """
    corners = bounds[_CORNERS, [0, 1, 2]]
    back = np.subtract(camera.position, camera.target)
    away = float(np.linalg.norm(back))
    depths = (camera.position - corners) @ (back / away)
    near, far = max(float(depths.min()), camera.near), float(depths.max())
    if far <= near:
        return WIDEST
    if camera.vertical_angle is None:
        width = (camera.height or 0.0) * camera.aspect
        return min(DEVIATION * width / (far - near), WIDEST)
    width = 2 * float(np.tan(camera.vertical_angle / 2)) * camera.aspect
    return min(DEVIATION * width * near * far / (far - near) / away, WIDEST)


def _turned(camera: Camera, bounds: Floats, axes: Axes, angle: float) -> Camera:
    """The camera turned about its target by ``angle`` (radians), to the right."""
    away = float(np.linalg.norm(np.subtract(camera.position, camera.target)))
    toward = np.cos(angle) * axes.back + np.sin(angle) * axes.right
    # What is off the axis comes nearer, or goes farther, by no more than this.
    more = abs(angle) * float(np.linalg.norm(bounds[1] - bounds[0]))
    return replace(
        camera,
        position=_triple(camera.target + away * toward),
        near=max(camera.near - more, 0.1 * camera.near),
        far=camera.far + more,
    )


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
