"""What is to be woven, and what it must keep clear of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance.obstacles import Obstacles


@dataclass(frozen=True, slots=True, eq=False)
class Threads:
    """h hyperedges that want curves.

    ``positions`` and unit, outward ``directions`` (a, 3) of their attachments, those of hyperedge k
    from ``starts[k]`` to ``starts[k + 1]`` (h + 1,); ``radii`` (h,). ``lows`` (h,): the lowest
    plane that looks right for each, or the very plane where it is ``given`` (h,).
    """

    positions: Floats
    directions: Floats
    starts: Indices
    radii: Floats
    lows: Floats
    given: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Still:
    """g hyperedges that have curves and keep them.

    ``segments`` (s, 4, 3) of the hyperedges ``owners`` (s,), numbered from 0, and their control
    points' ``boxes`` (s, 2, 3), smallest coordinates and largest; their ``feet``
    (a, 2), of the hyperedges ``feet_owners`` (a,); ``planes`` and ``radii`` (g,).
    """

    segments: Floats
    boxes: Floats
    owners: Indices
    feet: Floats
    feet_owners: Indices
    planes: Floats
    radii: Floats

    def near(self, low: Floats, high: Floats) -> Indices:
        """Numbers of the segments whose control points' box meets the one from low to high."""
        return _meeting(self.boxes, low, high)

    @staticmethod
    def nothing() -> Still:
        """Nothing stands still."""
        none = np.zeros(0, dtype=np.int64)
        return Still(
            np.zeros((0, 4, 3)),
            np.zeros((0, 2, 3)),
            none,
            np.zeros((0, 2)),
            none,
            np.zeros(0),
            np.zeros(0),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """Items to keep clear of, and which hyperedge attaches to which item: (k, 2), sorted.

    ``boxes`` (m, 2, 3) along the axes hold the obstacles: smallest coordinates and largest.
    """

    obstacles: Obstacles
    attached: Indices
    boxes: Floats

    @classmethod
    def of(cls, obstacles: Obstacles, attached: Indices) -> Surroundings:
        """With the boxes around balls that hold the obstacles."""
        reach = (np.linalg.norm(obstacles.halves, axis=1) + obstacles.roundings)[:, None]
        boxes = np.stack([obstacles.centers - reach, obstacles.centers + reach], axis=1)
        return cls(obstacles, attached, boxes)

    def near(self, low: Floats, high: Floats) -> Surroundings:
        """Only what may come into the box from low to high."""
        rows = _meeting(self.boxes, low, high)
        return Surroundings(self.obstacles.only(rows), self.attached, self.boxes[rows])


def _meeting(boxes: Floats, low: Floats, high: Floats) -> Indices:
    """Which of ``boxes`` (m, 2, 3) meet the one from low to high."""
    meets = (boxes[:, 0] <= high) & (boxes[:, 1] >= low)
    return np.flatnonzero(meets[:, 0] & meets[:, 1] & meets[:, 2])
