"""Routings of the ``steiner`` kind: short trees, woven so that they keep clear of each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.obstacles import obstacles_of
from app.hyperedges.clearance.passable import passable_items
from app.hyperedges.join_planes import choose_join_planes
from app.hyperedges.router import Progress, Routed, Router
from app.hyperedges.routing import Routing
from app.hyperedges.weaving.loose import lay_loosely
from app.hyperedges.weaving.numbering import number
from app.hyperedges.weaving.plan import feet_of
from app.hyperedges.weaving.threads import Still, Surroundings, Threads
from app.hyperedges.weaving.weave import weave
from app.placement.placement import Placement

ARCH = 1.5
"""Height of a plane above its attachments, over the root of span times radius.

With tubes of radius 0.08, a quarter of a span of three units, and an eighth of one of fifteen.
"""

LEAST_RISE = 4.0
"""Least height in radii: a bend and its way back."""


def plane_router(placement: Placement, clearance: float, join_heights: Floats) -> Router:
    """Routes in planes: curves that keep ``clearance``, if they can, from each other and items.

    ``join_heights`` (h,) are join planes, NaN where they are to be chosen.
    """
    around = Surroundings.of(obstacles_of(placement), passable_items(placement))

    def route(chosen: Indices, others: Routing, progress: Progress) -> Routed:
        hyperedges = np.arange(len(placement.radii))
        standing = np.setdiff1d(hyperedges, chosen, assume_unique=True)
        threads = _threads(placement, clearance, join_heights, chosen)
        still = _still(placement, standing, others) if len(standing) else Still.nothing()
        renumbered = np.empty_like(hyperedges)
        renumbered[np.concatenate([chosen, standing])] = hyperedges
        attached = around.attached.copy()
        attached[:, 0] = renumbered[attached[:, 0]]
        attached = attached[np.lexsort((attached[:, 1], attached[:, 0]))]
        woven = weave(threads, still, replace(around, attached=attached), clearance, progress)
        made = number(woven.plan, woven.fabric, woven.leaving, woven.planes, threads.radii)
        return Routed(made, was_stopped=not woven.tried)

    return Router(False, route)


def lay_all(placement: Placement, join_heights: Floats) -> Routing:
    """Curves of all hyperedges in planes of their own, wherever others are."""
    planes = choose_join_planes(placement, 0.0, join_heights)
    threads = _threads(placement, 0.0, planes, np.arange(len(placement.radii)))
    plan, fabric, leaving = lay_loosely(threads)
    return number(plan, fabric, leaving, planes, threads.radii)


def _threads(
    placement: Placement, clearance: float, join_heights: Floats, chosen: Indices
) -> Threads:
    starts = placement.attachment_starts
    rows = rows_of(starts, chosen)
    counts = np.diff(starts)[chosen]
    positions = placement.attachment_positions[rows]
    begins = starts_of(counts)
    radii = placement.radii[chosen]
    heights = join_heights[chosen]
    given = ~np.isnan(heights)
    lows = heights
    if len(chosen):
        low = np.minimum.reduceat(positions, begins[:-1], axis=0)
        high = np.maximum.reduceat(positions, begins[:-1], axis=0)
        spans = np.hypot(high[:, 0] - low[:, 0], high[:, 1] - low[:, 1])
        rises = np.maximum(ARCH * np.sqrt(spans * radii), LEAST_RISE * radii + clearance)
        lows = np.where(given, heights, high[:, 2] + rises)
    return Threads(positions, placement.attachment_directions[rows], begins, radii, lows, given)


def _still(placement: Placement, standing: Indices, old: Routing) -> Still:
    rows = rows_of(placement.attachment_starts, standing)
    counts = np.diff(placement.attachment_starts)[standing]
    owners = np.repeat(np.arange(len(standing)), counts)
    feet, _ = feet_of(
        placement.attachment_positions[rows],
        placement.attachment_directions[rows],
        old.radii[owners],
    )
    p = old.control_points
    lows = np.minimum(np.minimum(p[:, 0], p[:, 1]), np.minimum(p[:, 2], p[:, 3]))
    highs = np.maximum(np.maximum(p[:, 0], p[:, 1]), np.maximum(p[:, 2], p[:, 3]))
    return Still(
        old.control_points,
        np.stack([lows, highs], axis=1),
        np.repeat(np.arange(len(standing)), np.diff(old.segment_starts)),
        feet,
        owners,
        old.join_planes,
        old.radii,
    )
