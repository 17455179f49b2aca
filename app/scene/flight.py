"""A flight: from the usual view up and far, down along the tubes, and back."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats
from app.scene.camera import Farthest, axes_from
from app.scene.framing import ground_of
from app.scene.scene import Camera, Scene

ROUNDNESS = 4
"""Exponent of the superellipsoid around the scene that no camera enters: near to its box, and yet
smooth, so that a path along it is."""

GAP = 1.06
"""How many times farther from the middle than its surface every camera is."""

HIGH, LOW, LOWER = (-0.9, 1.05, 1.35), (-0.75, 0.26, 0.12), (0.8, 0.2, 0.08)
"""Where the flight goes: azimuth from the usual one, and elevation, in radians; and the distance
from the middle over the usual one, for the latter two the room before the nearest that may be.
The scene is passed low, along its front."""


def flight(scene: Scene, frames: int) -> tuple[Camera, ...]:
    """A camera for each frame of a round trip that begins and ends at rest in the scene's own.

    No camera is within the scene, and none cuts off what is near. An orthographic one comes nearer
    by seeing less.
    """
    around = _Around.the(scene)
    own = around.pose_of(scene.camera)
    azimuth, elevation, room, _ = own
    upward = -1.0 if elevation < 0 else 1.0
    usual = around.nearest(elevation, azimuth) + room
    high, low, lower = (
        np.array([azimuth + turn, upward * rise, share * usual, 0.0])
        for turn, rise, share in (HIGH, LOW, LOWER)
    )
    high[2] = max(high[2] - around.nearest(high[1], high[0]), 0.0)
    poles = np.stack([own, own, own, high, high, low, low, lower, lower, own, own, own])
    return tuple(around.camera(scene.camera, pose, usual) for pose in _spline(poles, frames))


@dataclass(frozen=True, slots=True, eq=False)
class _Around:
    """Poses around a scene: azimuth, elevation, room, and the share of the usual target.

    Room is how much farther from the middle a camera is than the nearest that may be.
    """

    bounds: Floats
    middle: Floats
    halves: Floats
    ground: Farthest | None

    @staticmethod
    def the(scene: Scene) -> _Around:
        bounds = scene.bounds
        halves = (bounds[1] - bounds[0]) / 2
        # What is flat, or a point, has room around it too.
        halves = np.maximum(halves, max(0.05 * float(halves.max()), 1e-3))
        return _Around(bounds, bounds.mean(axis=0), halves, ground_of(scene))

    def nearest(self, elevation: float, azimuth: float) -> float:
        """How far from the middle a camera must be: `GAP` times the superellipsoid's surface."""
        share = (np.abs(_outward(elevation, azimuth) / self.halves) ** ROUNDNESS).sum()
        return GAP * float((3.0 / share) ** (1 / ROUNDNESS))

    def pose_of(self, camera: Camera) -> Floats:
        """The pose (4,) of the scene's own camera; farther away if that comes too near."""
        x, y, z = np.subtract(camera.position, self.middle).tolist()
        flat = float(np.hypot(x, y))
        # From straight above +y is up, as if seen from -y; from below it is the other way round.
        is_steep = flat < 1e-6 * abs(z)
        azimuth = -float(np.copysign(np.pi / 2, z)) if is_steep else float(np.arctan2(y, x))
        elevation = float(np.arctan2(z, flat))
        room = float(np.hypot(flat, z)) - self.nearest(elevation, azimuth)
        return np.array([azimuth, elevation, max(room, 0.0), 1.0])

    def camera(self, own: Camera, pose: Floats, usual: float) -> Camera:
        """The camera in a pose (4,), where ``usual`` is the own one's distance."""
        azimuth, elevation, room, share = pose.tolist()
        away = self.nearest(elevation, azimuth) + room
        target = self.middle + share * (np.array(own.target) - self.middle)
        position = self.middle + away * _outward(elevation, azimuth)
        back = (position - target) / np.linalg.norm(position - target)
        if own.height is not None:
            depth = self._reach(back) - float(back @ target)
            position = target + (depth + float(self.halves.max())) * back
            own = replace(own, height=own.height * away / usual)
        return replace(
            own,
            position=_triple(position),
            target=_triple(target),
            up=_triple(axes_from(_triple(back)).up),
            near=self._near(own, position, back),
            far=1.1 * float(back @ position + self._reach(-back)),
        )

    def _reach(self, direction: Floats) -> float:
        """How far the scene's box and the ground reach along a unit direction (3,)."""
        box = float(np.maximum(self.bounds[0] * direction, self.bounds[1] * direction).sum())
        if self.ground is None:
            return box
        return max(box, float(self.ground(direction) @ direction))

    def _near(self, camera: Camera, position: Floats, back: Floats) -> float:
        """What is nearest lies no nearer: it may be in a corner of the picture."""
        if camera.vertical_angle is None:
            return 0.9 * float(back @ position - self._reach(back))
        beside = position - np.clip(position, self.bounds[0], self.bounds[1])
        room = float(np.linalg.norm(beside))
        if self.ground is not None:
            room = min(room, abs(float(position[2] - self.bounds[0, 2])))
        slope = float(np.tan(camera.vertical_angle / 2))
        corner = float(np.sqrt(1 + slope**2 * (1 + camera.aspect**2)))
        return max(0.9 * room / corner, 1e-3 * float(self.halves.max()))


def _spline(poles: Floats, frames: int) -> Floats:
    """Uniform cubic B-spline: smooth to the second derivative, and never outside its poles' hull.

    A pole given three times is reached, and at rest. Closed: the end is not given again.
    """
    place = np.arange(frames) / frames * (len(poles) - 3)
    first = place.astype(np.int64)
    t = (place - first)[:, None]
    weights = ((1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3)
    found: Floats = np.zeros((frames, poles.shape[1]))
    for number, weight in enumerate(weights):
        found += weight / 6 * poles[first + number]
    return found


def _outward(elevation: float, azimuth: float) -> Floats:
    flat = np.cos(elevation)
    return np.array([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)])


def _triple(vector: Floats) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
