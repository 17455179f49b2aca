"""Which curves are near which items, but for where hyperedges leave or pass these."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.obstacle_gaps import near_obstacles
from app.hyperedges.clearance.obstacles import Obstacles
from app.hyperedges.clearance.own_bodies import beyond_own_balls, leaving_radii
from app.hyperedges.clearance.passable import are_among, attached_items, containing_items
from app.placement.placement import Placement


class CurvesNearItems(NamedTuple):
    """Curves, and pairs (m, 2) of one and a box of an obstacle that may be too near.

    The curves are all segments, then what of some is beyond the balls about their attachments:
    ``points`` (c, 4, 3), of the hyperedges ``owners``, of ``radii``, parts of ``segments`` (c,).
    """

    points: Floats
    owners: Indices
    radii: Floats
    segments: Indices
    pairs: Indices


@dataclass(frozen=True, slots=True, eq=False)
class ItemsAround:
    """The items of a placement as its hyperedges have to do with them.

    ``attached`` and ``containing`` (k, 2) name hyperedges with items of their own and with what
    contains these; ``balls`` (a,) are radii about attachments within which the former do not count,
    for curves that keep a ``clearance``.
    """

    obstacles: Obstacles
    placement: Placement
    attached: Indices
    containing: Indices
    balls: Floats
    clearance: float

    @classmethod
    def of(cls, placement: Placement, obstacles: Obstacles, clearance: float) -> ItemsAround:
        """With the ``obstacles`` that count, which are of the placement."""
        return cls(
            obstacles,
            placement,
            attached_items(placement),
            containing_items(placement),
            leaving_radii(placement, obstacles.bodies, clearance),
            clearance,
        )

    def near(
        self,
        points: Floats,
        owners: Indices,
        radii: Floats,
        reach: float,
        active: Flags | None = None,
    ) -> CurvesNearItems:
        """What may be nearer than ``reach`` to segments, as `near_obstacles` takes them.

        No hyperedge is near the labels of its own items.
        """
        pairs = near_obstacles(
            points, owners, radii, self.obstacles, self.containing, reach, active
        )
        named = np.stack([owners[pairs[:, 0]], self.obstacles.items[pairs[:, 1]]], axis=1)
        own = are_among(named, self.attached)
        all_segments = np.arange(len(points))
        if not own.any():
            return CurvesNearItems(points, owners, radii, all_segments, pairs)
        beside = np.flatnonzero(own & ~self.obstacles.is_label[pairs[:, 1]])
        pieces, rows = beyond_own_balls(
            points[pairs[beside, 0]], named[beside], self.placement, self.balls
        )
        segments, boxes = pairs[beside[rows]].T
        numbers = len(points) + np.arange(len(pieces))
        return CurvesNearItems(
            np.concatenate([points, pieces]),
            np.concatenate([owners, owners[segments]]),
            np.concatenate([radii, radii[segments]]),
            np.concatenate([all_segments, segments]),
            np.concatenate([pairs[~own], np.stack([numbers, boxes], axis=1)]),
        )
