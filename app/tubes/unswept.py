"""Tubes of very many hyperedges, made a few at a time: together they would fill the memory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.tubes.circle import cap_rings
from app.tubes.sweep import sweep
from app.tubes.tessellation import tessellation_of
from app.tubes.tubes import Tubes


@dataclass(frozen=True, slots=True, eq=False)
class UnsweptTubes:
    """What is needed to sweep the tubes of any of h hyperedges.

    ``tolerances`` (h,) are as in `app.tubes.sweep.sweep`; ``vertex_counts`` (h,) say how many
    vertices each will have.
    """

    routing: Routing
    tolerances: Floats
    vertex_counts: Indices

    @staticmethod
    def of(routing: Routing, tolerance: float | Floats) -> UnsweptTubes:
        """The tubes that ``sweep(routing, tolerance)`` would make at once.

        Raises ValueError where a tolerance is not positive.
        """
        plan = tessellation_of(routing, tolerance)
        free = plan.ends.free.sum(axis=1)
        counts = (plan.rings.counts + free * cap_rings(plan.sides)) * plan.sides + free
        return UnsweptTubes(
            routing,
            np.broadcast_to(tolerance, routing.radii.shape),
            np.add.reduceat(counts, routing.segment_starts[:-1]),
        )

    def swept(self, hyperedges: Indices) -> Tubes:
        """The tubes of ``hyperedges`` (k,), in that order: equal to the bit, whoever is beside."""
        return sweep(self.routing.part(hyperedges), self.tolerances[hyperedges])
