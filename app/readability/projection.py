"""How points in space are seen: where in the picture, how near, and how large things are there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.arrays import Floats


class Seen(NamedTuple):
    """Points as they are seen.

    ``places`` (n, 2), to the right and up; ``nearness`` (n,), more where nearer to the reader, and
    linear along planes in the picture; ``scales`` (n,): lengths in the picture over those in space.
    """

    places: Floats
    nearness: Floats
    scales: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """A direction, or a place, from which things are seen.

    The rows of ``axes`` (3, 3) are unit vectors: to the right, up, and back from the scene to the
    reader. Without an ``eye`` (3,) the reader is infinitely far away, and places are in document
    units; with one they are tangents of angles.
    """

    axes: Floats
    eye: Floats | None = None

    def seen(self, points: Floats, nearer: Floats | float = 0.0) -> Seen:
        """How ``points`` (n, 3) are seen, with the nearness of what is ``nearer`` (n,) than they.

        Raises `ValueError` where one of them is not before the eye.
        """
        if self.eye is None:
            there = points @ self.axes.T
            return Seen(there[:, :2], there[:, 2] + nearer, np.ones(len(points)))
        there = (points - self.eye) @ self.axes.T
        ahead = -there[:, 2]
        front = ahead - nearer
        if len(points) and float(min(ahead.min(), front.min())) <= 0.0:
            raise ValueError("What is seen lies before the eye.")
        return Seen(there[:, :2] / ahead[:, None], 1.0 / front, 1.0 / ahead)


def directions(count: int) -> Floats:
    """Directions (``count``, 3) from which a scene is seen from above, evenly over a half sphere.

    The lattice of Fibonacci: equal steps of height, turned by the golden angle.
    """
    number = np.arange(count) + 0.5
    heights = number / count
    turns = number * np.pi * (3.0 - np.sqrt(5.0))
    rims = np.sqrt(1.0 - heights**2)
    return np.stack([rims * np.cos(turns), rims * np.sin(turns), heights], axis=1)
