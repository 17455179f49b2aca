"""Three-point light: a key from the upper left, a fill beside the camera, a rim from behind."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats
from app.scene.camera import Axes
from app.scene.scene import Light

LOWEST = 0.75
"""Height of the sun and of the rim light over their distance on the ground: longer shadows hide
more than they show."""

# White, lit in full, is π lux bright. Together they leave white below white, so that colours
# keep their differences, and give a surface that faces the camera three quarters of it.
KEY, FILL, RIM = 2.35, 1.25, 0.75


def three_point(axes: Axes, *, is_upright: bool = False) -> tuple[Light, ...]:
    """Suns for a camera with ``axes``; the first alone casts shadows.

    Key and rim shine from above even on a scene that is seen from below. The key shines along the
    reader's eyes where the scene ``is_upright``: from above, what stands out of its front would
    throw streaks down it.
    """
    right, up, back = axes.right, axes.up, axes.back
    if is_upright:
        return (
            _sun("key", -0.25 * right + 0.35 * up + back, (1.0, 0.98, 0.95), KEY, True),
            _sun("fill", 0.7 * right + 0.15 * up + 0.9 * back, (0.95, 0.97, 1.0), FILL, False),
            _sun("rim", 0.4 * right + 0.8 * up - 0.5 * back, (1.0, 1.0, 1.0), RIM, False),
        )
    return (
        _sun("key", _lifted(-0.6 * right + 0.7 * up + 0.6 * back), (1.0, 0.98, 0.95), KEY, True),
        _sun("fill", 0.7 * right + 0.15 * up + 0.9 * back, (0.95, 0.97, 1.0), FILL, False),
        _sun("rim", _lifted(0.4 * right + 0.6 * up - 0.7 * back), (1.0, 1.0, 1.0), RIM, False),
    )


def _lifted(toward: Floats) -> Floats:
    """The same heading, high enough above the horizon."""
    height = max(toward[2], LOWEST * float(np.hypot(toward[0], toward[1])))
    return np.array([toward[0], toward[1], height])


def _sun(
    name: str, toward: Floats, color: tuple[float, float, float], illuminance: float, shadows: bool
) -> Light:
    x, y, z = (-toward / np.linalg.norm(toward)).tolist()
    return Light(name, (x, y, z), color, illuminance, shadows)
