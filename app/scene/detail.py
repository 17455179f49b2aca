"""Level of detail: how far a tube's mesh may be from its tube before a picture shows it."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.program.model import View
from app.scene.camera import axes_from, frame
from app.scene.curve_reach import CurveReach, curve_boxes
from app.scene.scene import Camera

UNSEEN = 0.1
"""Pixels by which a mesh may be off in the picture asked for: so one may go ten times as near
before it is off by one."""

COARSEST = 0.5
"""Share of its radius by which a tube may be off at most, however small it is in the picture: who
flies up to it sees edges, but finds it where it should be."""

_CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])


def tolerances(
    placement: Placement, routing: Routing, view: View, aspect: float, height: int, finest: float
) -> Floats:
    """How far the tubes of each of h hyperedges may be off, (h,), in document units.

    For a picture ``height`` pixels high of ``aspect`` (width over height): `UNSEEN` pixels where
    the tube comes nearest to the camera, but not less than ``finest`` (document units), nor more
    than `COARSEST` of its radius where that is more than ``finest``.
    """
    curves, items = CurveReach.of(routing), _item_corners(placement)

    def farthest(way: Floats) -> Floats:
        best = curves.farthest(way)
        if len(items):
            other: Floats = items[int(np.argmax(items @ way))]
            best = other if other @ way > best @ way else best
        return best

    camera = frame(farthest, view, aspect)
    back = axes_from(view.from_).back
    low, high = curve_boxes(routing).transpose(1, 0, 2)
    nearest = (low + high) / 2 @ back + (high - low) / 2 @ np.abs(back)
    depths = float(camera.position @ back) - nearest
    allowed = UNSEEN * _heights(camera, depths) / height
    return np.maximum(np.minimum(allowed, COARSEST * routing.radii), finest)


def _heights(camera: Camera, depths: Floats) -> Floats:
    """How many document units the picture is high at each of ``depths`` (h,) before the camera."""
    if camera.vertical_angle is not None:
        slope = 2.0 * float(np.tan(camera.vertical_angle / 2.0))
        return slope * np.maximum(depths, camera.near)
    if camera.height is None:
        raise ValueError("A camera needs an angle or a height.")
    return np.full(len(depths), camera.height)


def _item_corners(placement: Placement) -> Floats:
    """Corners (8 n, 3) of the items' boxes, turned as they are."""
    turns = matrices(placement.rotations)
    own = placement.sizes[:, None] * (_CORNERS - 0.5)
    return np.asarray(own @ turns.transpose(0, 2, 1) + placement.centers[:, None]).reshape(-1, 3)
