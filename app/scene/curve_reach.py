"""How far tubes reach in any direction: exactly, from their curves alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Floats
from app.hyperedges.routing import Routing


@dataclass(frozen=True, slots=True, eq=False)
class CurveReach:
    """Curves (s, 4, 3), by their control points, with balls of ``radii`` (s,) moving along them."""

    control_points: Floats
    radii: Floats

    @staticmethod
    def of(routing: Routing) -> CurveReach:
        """Of all tubes of a routing; there must be one."""
        counts = np.diff(routing.segment_starts)
        return CurveReach(routing.control_points, np.repeat(routing.radii, counts))

    def farthest(self, direction: Floats) -> Floats:
        """The point (3,) of all tubes that lies farthest along ``direction`` (3,)."""
        length = float(np.linalg.norm(direction))
        segment, place = _farthest(self.control_points, self.radii * length, direction)
        p, q, r, s = self.control_points[segment]
        rest = 1.0 - place
        point = rest**3 * p + 3 * rest**2 * place * q + 3 * rest * place**2 * r + place**3 * s
        return np.asarray(point + self.radii[segment] / length * direction)


def curve_boxes(routing: Routing) -> Floats:
    """Boxes around the tubes of each hyperedge, (h, 2, 3): none smaller, some a little larger.

    No curve leaves the box of its control points; those of its halves (de Casteljau) are near it.
    """
    p, q, r, s = routing.control_points.transpose(1, 0, 2)
    first, middle, last = (p + q) / 2, (q + r) / 2, (r + s) / 2
    before, after = (first + middle) / 2, (middle + last) / 2
    points = (p, first, before, after, last, s)
    starts = routing.segment_starts[:-1]
    lows = np.minimum.reduceat(np.minimum.reduce(points), starts, axis=0)
    highs = np.maximum.reduceat(np.maximum.reduce(points), starts, axis=0)
    radii = routing.radii[:, None]
    return np.stack([lows - radii, highs + radii], axis=1)


@njit(cache=True, error_model="numpy")
def _farthest(control_points: Floats, added: Floats, direction: Floats) -> tuple[int, float]:
    """The segment, and the place on it, whose way along ``direction``, with ``added``, is largest.

    A cubic along a direction is largest at an end or where its derivative is zero.
    """
    best, segment, place = -np.inf, 0, 0.0
    x, y, z = direction
    for k in range(len(control_points)):
        c = control_points[k]
        p = x * c[0, 0] + y * c[0, 1] + z * c[0, 2]
        q = x * c[1, 0] + y * c[1, 1] + z * c[1, 2]
        r = x * c[2, 0] + y * c[2, 1] + z * c[2, 2]
        s = x * c[3, 0] + y * c[3, 1] + z * c[3, 2]
        if not max(p, q, r, s) + added[k] > best:
            continue
        if p + added[k] > best:
            best, segment, place = p + added[k], k, 0.0
        if s + added[k] > best:
            best, segment, place = s + added[k], k, 1.0
        # The derivative is a + 2 b t + c t², over 3.
        a, b, d = q - p, r - 2.0 * q + p, s - 3.0 * r + 3.0 * q - p
        square = b * b - a * d
        if square < 0.0:
            continue
        # One root by adding what has the same sign, the other from the product of both.
        sum_ = -b - math.copysign(math.sqrt(square), b)
        for over, under in ((sum_, d), (a, sum_)):
            if under != 0.0 and 0.0 < over / under < 1.0:
                t = over / under
                u = 1.0 - t
                reached = u * u * u * p + 3 * u * u * t * q + 3 * u * t * t * r + t * t * t * s
                if reached + added[k] > best:
                    best, segment, place = reached + added[k], k, t
    return segment, place
