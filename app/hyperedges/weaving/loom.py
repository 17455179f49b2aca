"""Laying courses, and checking them: what stays the same while they are made stricter."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.stopping import unchecked
from app.hyperedges.weaving.fabric import Fabric, lay_courses
from app.hyperedges.weaving.faults import PINCH, Faults, find_faults
from app.hyperedges.weaving.plan import Plan
from app.hyperedges.weaving.threads import Still, Surroundings, Threads
from app.hyperedges.weaving.ways import Ways


@dataclass(frozen=True, slots=True, eq=False)
class Check:
    """What is wrong with a fabric of e edges.

    ``near`` (m, 2) are edges that come too near to each other, e for what stands still;
    ``hyperedges`` (m, 2) those that they are of. ``at_items`` (n,) are edges too near to items,
    ``pinched`` (e,) those that bend too much.
    """

    faults: Faults
    near: Indices
    hyperedges: Indices
    at_items: Indices
    pinched: NDArray[np.bool_]

    @property
    def edges(self) -> NDArray[np.bool_]:
        """Which edges (e,) are too near to something."""
        found = np.zeros(len(self.pinched) + 1, dtype=np.bool_)
        found[self.near] = True
        found[self.at_items] = True
        return found[:-1]


@dataclass(frozen=True, slots=True, eq=False)
class Loom:
    """A plan with its tangents, among what stands still and items.

    ``leaving`` (e, 2, 2) are the directions in which edges leave joins, ``ends`` (e, 2, 2) the
    places up to which they follow them; ``owners`` (e,) the edges' hyperedges. ``radii`` (h,) are
    those of threads, then of what stands still.
    """

    plan: Plan
    leaving: Floats
    ends: Floats
    owners: Indices
    threads: Threads
    still: Still
    surroundings: Surroundings
    radii: Floats
    clearance: float

    def lay(self, ways: Ways, strictness: Indices, planes: Floats) -> Fabric:
        """Courses of all edges, as strict as ``strictness`` (e,), at ``planes`` (h,)."""
        return lay_courses(
            self.plan,
            ways,
            strictness,
            self.leaving,
            self.ends,
            self.threads.positions,
            self.threads.directions,
            planes,
            self.radii,
        )

    def check(
        self,
        fabric: Fabric,
        active: NDArray[np.bool_],
        check: Callable[[], None] = unchecked,
    ) -> Check:
        """What is wrong around the ``active`` (e,) edges of a fabric.

        ``check`` is called now and then, and may raise to end it.
        """
        woven = len(self.threads.radii)
        edges = np.repeat(np.arange(len(active)), np.diff(fabric.starts))
        owners = np.repeat(self.owners, np.diff(fabric.starts))
        # What is far from all that is active need not be looked at.
        reach = float(self.radii.max(initial=0.0)) * 2.0 + self.clearance
        points = fabric.segments[active[edges]].reshape(-1, 3)
        low = points.min(axis=0, initial=np.inf) - reach
        high = points.max(axis=0, initial=-np.inf) + reach
        near = self.still.near(low, high)
        edges = np.append(edges, np.full(len(near), len(active)))
        owners = np.append(owners, self.still.owners[near] + woven)
        faults = find_faults(
            np.concatenate([fabric.segments, self.still.segments[near]]),
            owners,
            self.radii[owners],
            self.clearance,
            self.surroundings.near(low, high),
            np.append(active, False)[edges],
            check,
        )
        return Check(
            faults,
            edges[faults.pairs],
            owners[faults.pairs],
            edges[faults.at_items],
            fabric.least < PINCH,
        )
