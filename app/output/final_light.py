"""Light for final pictures: a studio at infinity, so that the ground is lit evenly everywhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Singles
from app.scene.scene import Light

HEIGHT, WIDTH = 512, 1024
"""Of the map: a texel is a third of a degree wide, and the smallest light is six of them."""

HORIZON = 0.25
"""Radiance at the horizon and below, that straight above being 1: metal and glass show their shape
by what is darker in what they mirror, and what stands low between others gets less light."""

BOXES = ((0.035, 0.66), (0.4, 0.05), (0.3, 0.06))
"""Of key, fill and rim: half their angle in radians, and the share that each has of the light that
falls on the ground. Beside them the sky shines; the more it does, the paler the shadows. The shadow
of a tube keeps a dark core until the tube runs 1 / 0.035, some thirty, of its radii high."""


@dataclass(frozen=True, slots=True, eq=False)
class Studio:
    """Radiance from all directions, linear RGB (HEIGHT, WIDTH, 3), as Mitsuba maps it with y up.

    White ground under it, with nothing around, has radiance 1.
    """

    radiance: Singles


def studio(lights: Sequence[Light]) -> Studio:
    """Softboxes where the scene's suns stand, in a sky."""
    directions, solid_angles = _directions()
    up = np.clip(directions[..., 2], 0.0, None) * solid_angles / np.pi
    height = directions[..., 2:3]
    sky = HORIZON + (1.0 - HORIZON) * np.sqrt(np.clip(height, 0.0, None))
    radiance = np.repeat(sky, 3, axis=2)
    boxes = np.zeros_like(radiance)
    shares = 0.0
    for light, (angle, share) in zip(lights, BOXES, strict=False):
        box = _softbox(directions, -np.asarray(light.direction), angle)[..., None] * light.color
        falling = float((box.mean(axis=2) * up).sum())
        if falling > 1e-4:
            boxes += box * (share / falling)
            shares += share
    radiance *= (1.0 - shares) / float((radiance.mean(axis=2) * up).sum())
    radiance += boxes
    radiance /= (radiance * up[..., None]).sum(axis=(0, 1))
    return Studio(radiance.astype(np.float32))


def _softbox(directions: Floats, toward: Floats, angle: float) -> Floats:
    """1 within ``angle`` of a direction, and soft at the rim, (HEIGHT, WIDTH)."""
    cosine = directions @ (toward / np.linalg.norm(toward))
    away = np.arccos(np.clip(cosine, -1.0, 1.0))
    rim = np.clip((angle - away) / (0.25 * angle), 0.0, 1.0)
    return np.asarray(rim * rim * (3.0 - 2.0 * rim))


def _directions() -> tuple[Floats, Floats]:
    """Where each texel is in the world, z up (HEIGHT, WIDTH, 3), and its solid angle."""
    polar = ((np.arange(HEIGHT) + 0.5) / HEIGHT * np.pi)[:, None]
    turn = ((np.arange(WIDTH) + 0.5) / WIDTH * 2 * np.pi)[None]
    x = np.sin(turn) * np.sin(polar)
    y = np.cos(turn) * np.sin(polar)
    z = np.broadcast_to(np.cos(polar), x.shape)
    solid_angles = np.broadcast_to(np.sin(polar) * (np.pi / HEIGHT) * (2 * np.pi / WIDTH), x.shape)
    return np.stack([x, y, z], axis=-1), solid_angles
