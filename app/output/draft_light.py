"""Light for the draft: the scene's suns, a sky around them, an exposure, and shadow cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Singles
from app.scene.scene import Light

MOST_LIGHTS = 6
"""As many as the shader has room for; of more, the brightest."""

SKY, EARTH = 0.45, 0.16
"""Light from above and from below, as shares of what all suns together give."""

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True, slots=True, eq=False)
class Lighting:
    """What shines, scaled so that white paper facing the light is white and no whiter.

    ``toward`` (l, 3) point at the lights, ``radiance`` (l, 3) is linear RGB; the first casts
    shadows if ``shadows``. ``sky`` and ``earth`` (3,) come from above and from below.
    """

    toward: Floats
    radiance: Floats
    sky: Floats
    earth: Floats
    shadows: bool

    @property
    def sun(self) -> Floats | None:
        """Toward the light that casts shadows (3,), if one does."""
        return self.toward[0] if self.shadows else None

    @property
    def on_the_ground(self) -> float:
        """Luminance of what falls on the ground where nothing casts a shadow."""
        return float((self.at(np.array([[0.0, 0.0, 1.0]])) @ _LUMINANCE)[0])

    def at(self, normals: Floats) -> Floats:
        """Light that falls on unshadowed white paper with ``normals`` (n, 3): (n, 3)."""
        direct = np.clip(normals @ self.toward.T, 0.0, None) @ self.radiance
        up = 0.5 + 0.5 * normals[:, 2:3]
        return np.asarray(direct + self.earth * (1 - up) + self.sky * up)


def lighting(lights: Sequence[Light]) -> Lighting:
    """The scene's lights with the sun that casts shadows first, a sky, and an exposure."""
    brightest = sorted(lights, key=lambda light: (not light.casts_shadows, -light.illuminance))[
        :MOST_LIGHTS
    ]
    if not brightest:
        brightest = [Light("none", (0.0, 0.0, -1.0), (1.0, 1.0, 1.0), 0.0, casts_shadows=False)]
    toward = -_unit(np.array([light.direction for light in brightest], dtype=np.float64))
    radiance = np.array([np.multiply(light.color, light.illuminance) for light in brightest])
    total = radiance.sum(axis=0) if radiance.any() else np.ones(3)
    raw = Lighting(toward, radiance, SKY * total, EARTH * total, brightest[0].casts_shadows)
    exposure = 1.0 / float((raw.at(_directions(512)) @ _LUMINANCE).max())
    return Lighting(
        toward, radiance * exposure, raw.sky * exposure, raw.earth * exposure, raw.shadows
    )


@dataclass(frozen=True, slots=True, eq=False)
class ShadowCamera:
    """What a light sees: ``matrix`` (4, 4) turns the world to the map that it draws.

    All three coordinates of the map run from 0 to 1, depth away from the light; ``extent`` (3,)
    are their lengths in the world.
    """

    matrix: Floats
    extent: Floats

    @property
    def clip_matrix(self) -> Floats:
        """World to what OpenGL cuts at: from -1 to 1."""
        return np.asarray(
            np.array([[2, 0, 0, -1], [0, 2, 0, -1], [0, 0, 2, -1], [0, 0, 0, 1.0]]) @ self.matrix
        )


def shadow_camera(
    toward: Floats, casters: Singles, edge: float, margin: float = 0.0
) -> ShadowCamera:
    """The view from where ``toward`` (3,) points, as tight around ``casters`` as it goes.

    ``casters`` are positions (v, 3). What they cover keeps the share ``edge`` of the map,
    and ``margin`` in the world, away from its border.
    """
    back = toward / np.linalg.norm(toward)
    side = np.cross([0.0, 1.0, 0.0] if abs(back[2]) > 0.99 else [0.0, 0.0, 1.0], back)
    side /= np.linalg.norm(side)
    axes = np.array([side, np.cross(back, side), -back])
    seen = axes.astype(np.float32) @ casters.T
    low, high = (np.asarray(end, dtype=np.float64) for end in (seen.min(axis=1), seen.max(axis=1)))
    around = np.array([margin, margin, 0.0])
    share = np.array([edge, edge, 0.01])
    extent = np.maximum(high - low + 2 * around, 1e-4) / (1 - 2 * share)
    matrix = np.eye(4)
    matrix[:3, :3] = axes / extent[:, None]
    matrix[:3, 3] = 0.5 - (low + high) / (2 * extent)
    return ShadowCamera(matrix, extent)


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _directions(count: int) -> Floats:
    """Directions spread evenly over the sphere, (count, 3): a spiral by the golden angle."""
    turn = np.arange(count) * (np.pi * (3 - np.sqrt(5)))
    z = 1 - (2 * np.arange(count) + 1) / count
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
