"""Curves that care about their own shape only, not about each other."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats
from app.hyperedges.weaving.courses import SOFT, STEEP
from app.hyperedges.weaving.fabric import Fabric, lay_courses
from app.hyperedges.weaving.faults import PINCH
from app.hyperedges.weaving.grid import sort_into_cells
from app.hyperedges.weaving.joins import settle_joins
from app.hyperedges.weaving.plan import Plan, draw_plan
from app.hyperedges.weaving.tangents import choose_tangents, inner_ends
from app.hyperedges.weaving.threads import Threads
from app.hyperedges.weaving.ways import Ways


def lay_loosely(threads: Threads) -> tuple[Plan, Fabric, Floats]:
    """Soft arches at the planes ``threads.lows``, stricter ones where those would pinch.

    Returns the plan, its courses, and the directions (e, 2, 2) in which edges leave joins.
    """
    plan = draw_plan(threads.positions, threads.directions, threads.starts, threads.radii)
    edges = np.repeat(np.arange(len(threads.radii)), np.diff(plan.edge_starts))
    nobody = np.zeros(0, dtype=np.int64)
    nowhere = np.zeros((0, 2))
    around = (sort_into_cells(nowhere, 1.0), nowhere, nobody, threads.lows, threads.radii, 0.0)
    settle_joins(plan, *around)
    leaving = choose_tangents(plan, *around)
    ends = inner_ends(plan, leaving, edges, threads.radii)
    ways = Ways(
        np.zeros(len(edges) + 1, dtype=np.int64), nowhere, np.zeros(len(edges), dtype=np.bool_)
    )
    strictness = np.full(len(edges), SOFT)
    while True:
        fabric = lay_courses(
            plan,
            ways,
            strictness,
            leaving,
            ends,
            threads.positions,
            threads.directions,
            threads.lows,
            threads.radii,
        )
        pinched = (fabric.least < PINCH) & (strictness < STEEP)
        if not pinched.any():
            return plan, fabric, leaving
        strictness[pinched] += 1
