"""Where curves bend too tightly for their tubes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.hyperedges.weaving.curvature import least_radius

LEAST = 1.5
"""Radius of curvature below which a curve pinches, over its tube's radius."""


@dataclass(frozen=True, slots=True, eq=False)
class Pinches:
    """Segments (p,) that bend too tightly, in order, and their least radii of curvature (p,)."""

    segments: Indices
    radii: Floats


def find_pinches(routing: Routing) -> Pinches:
    """Segments with a radius of curvature below `LEAST` times their tube's radius."""
    radii = _least_radii(np.ascontiguousarray(routing.control_points))
    thick = np.repeat(routing.radii, np.diff(routing.segment_starts))
    segments = np.flatnonzero(radii < LEAST * thick)
    return Pinches(segments, radii[segments])


@njit(cache=True)
def _least_radii(control_points: Floats) -> Floats:
    radii = np.empty(len(control_points))
    for i in range(len(control_points)):
        radii[i] = least_radius(control_points[i])
    return radii
