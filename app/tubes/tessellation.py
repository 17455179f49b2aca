"""How finely the tubes of a routing are divided: what swept tubes and patches have in common."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.tubes.circle import sides_of, tolerances_of
from app.tubes.ends import Ends, ends_of
from app.tubes.rings import RingPlan, plan_rings


@dataclass(frozen=True, slots=True, eq=False)
class Tessellation:
    """For s segments: ``hyperedges`` (s,) they belong to, ``sides`` (s,), their ends and rings."""

    hyperedges: Indices
    sides: Indices
    ends: Ends
    rings: RingPlan


def tessellation_of(routing: Routing, tolerance: float | Floats) -> Tessellation:
    """Sides by radius, the same for a whole hyperedge, and rings by curvature.

    No chord around a tube is off by more than ``tolerance`` (document units; one for all, or one
    for each hyperedge, (h,)), nor one along it.
    Raises ValueError where the tolerance is not positive.
    """
    counts = np.diff(routing.segment_starts)
    hyperedges = np.repeat(np.arange(len(counts)), counts)
    ends = ends_of(routing, hyperedges)
    tolerances = tolerances_of(routing.radii, tolerance)
    return Tessellation(
        hyperedges=hyperedges,
        sides=sides_of(routing.radii, tolerance)[hyperedges],
        ends=ends,
        rings=plan_rings(routing.control_points, hyperedges, ends, routing.radii, tolerances),
    )
