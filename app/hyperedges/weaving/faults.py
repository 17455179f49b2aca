"""What is wrong with curves: which edges come too near to something, and which pinch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.clearance.obstacle_gaps import near_obstacles, obstacle_gaps
from app.hyperedges.clearance.pairs import close_pairs
from app.hyperedges.stopping import unchecked
from app.hyperedges.weaving.threads import Surroundings

PINCH = 1.53
"""Least radius of curvature over the tube's radius: a little more than the 1.5 that is asked for,
because it is looked for at some places only."""

TOLERANCE = 0.05
"""How far bounds of distances may be apart; only yes or no matters here."""


@dataclass(frozen=True, slots=True, eq=False)
class Faults:
    """Pairs (m, 2) of segments that are too near to each other, and segments too near to items.

    ``depths`` (m,): by how much pairs are too near; ``heights`` (m, 2): how high their curves are
    there.
    """

    pairs: Indices
    depths: Floats
    heights: Floats
    at_items: Indices

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.pairs) + len(self.at_items)


def find_faults(
    segments: Floats,
    owners: Indices,
    radii: Floats,
    clearance: float,
    surroundings: Surroundings,
    active: NDArray[np.bool_],
    check: Callable[[], None] = unchecked,
) -> Faults:
    """What is nearer than ``clearance`` among ``segments`` (s, 4, 3) and items.

    ``owners`` (s,) are the segments' hyperedges, ``radii`` (s,) their tubes'. Only what has to do
    with ``active`` (s,) segments is looked at. ``check`` is called now and then, and may raise to
    end it.
    """
    pairs, apart = close_pairs(segments, owners, radii, clearance, active, TOLERANCE, check)
    check()
    obstacles, attached = surroundings.obstacles, surroundings.attached
    beside = near_obstacles(segments, owners, radii, obstacles, attached, clearance, active)
    away = obstacle_gaps(segments, radii, obstacles, beside, clearance, TOLERANCE)
    t = apart.at
    z = segments[pairs, :, 2]
    return Faults(
        pairs,
        clearance - apart.lower,
        np.asarray(
            (1 - t) ** 3 * z[..., 0]
            + 3 * t * (1 - t) ** 2 * z[..., 1]
            + 3 * t**2 * (1 - t) * z[..., 2]
            + t**3 * z[..., 3]
        ),
        np.unique(beside[away.lower < clearance, 0]),
    )
