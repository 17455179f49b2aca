"""Projections for tests."""

from __future__ import annotations

import numpy as np

from app.readability.projection import Projection
from app.scene.camera import axes_from


def seen_from(
    x: float, y: float, z: float, eye: tuple[float, float, float] | None = None
) -> Projection:
    """As the camera sees from a direction, from infinitely far away or from ``eye``."""
    axes = axes_from((x, y, z))
    rows = np.stack([axes.right, axes.up, axes.back])
    return Projection(rows, None if eye is None else np.array(eye))


ABOVE = seen_from(0.0, 0.0, 1.0)
"""The picture's right is x, up is y, and what is higher is nearer."""
