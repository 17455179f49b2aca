"""Level of detail: how far a mesh may be from what it stands for before a picture shows it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from app.placement.turning import matrices
from app.program.model import View
from app.scene.camera import axes_of, frame
from app.scene.curve_reach import CurveReach, curve_boxes
from app.scene.reach import farther_of
from app.scene.scene import Camera

UNSEEN = 0.1
"""Pixels by which a mesh may be off in the picture asked for: so one may go ten times as near
before it is off by one."""

COARSEST = 0.5
"""Share of its radius by which a tube may be off at most, however small it is in the picture: who
flies up to it sees edges, but finds it where it should be."""

_CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])


@dataclass(frozen=True, slots=True, eq=False)
class Detail:
    """How far meshes may be off in a picture ``height`` pixels high that ``camera`` takes.

    ``corners`` (8 n, 3) are those of the items' boxes; ``back`` is the unit vector from what is
    seen towards the camera.
    """

    corners: Floats
    camera: Camera
    back: Floats
    height: int

    @classmethod
    def of(
        cls, placement: Placement, routing: Routing, view: View, aspect: float, height: int
    ) -> Detail:
        """For a picture of everything, of ``aspect`` (width over height)."""
        items = _item_corners(placement)

        def of_items(way: Floats) -> Floats:
            return np.asarray(items[int(np.argmax(items @ way))])

        of_tubes = CurveReach.of(routing).farthest if len(routing.radii) else None
        farthest = farther_of(of_tubes, of_items if len(items) else None)
        camera = frame(farthest, view, aspect)
        return cls(items, camera, axes_of(view).back, height)

    def tubes(self, routing: Routing, finest: float) -> Floats:
        """Of the tubes of each of h hyperedges that are seen, (h,), in document units.

        `UNSEEN` pixels where the tube comes nearest to the camera, but not less than ``finest``
        (document units), nor more than `COARSEST` of its radius where that is more.
        """
        low, high = curve_boxes(routing).transpose(1, 0, 2)
        nearest = (low + high) / 2 @ self.back + (high - low) / 2 @ np.abs(self.back)
        allowed = self._unseen(nearest)
        return np.maximum(np.minimum(allowed, COARSEST * routing.radii), finest)

    def items(self) -> float:
        """Of all items, in document units: no more than `UNSEEN` pixels at the nearest.

        A power of two, so that a picture that shows a little more or less has the same meshes.
        """
        if not len(self.corners):
            return 0.0
        nearest = (self.corners @ self.back).max(keepdims=True)
        return float(2.0 ** np.floor(np.log2(self._unseen(nearest)[0])))

    def _unseen(self, nearest: Floats) -> Floats:
        """What `UNSEEN` pixels are, so far towards the camera."""
        depths = float(self.camera.position @ self.back) - nearest
        return UNSEEN * _heights(self.camera, depths) / self.height


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
