"""Curves of hyperedges of a placement by relaxation, beside those of all others."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.clearance.passable import containing_items, with_parts
from app.hyperedges.elastic.fixed import curves_of, fixed_beside
from app.hyperedges.elastic.neighbours import Items
from app.hyperedges.elastic.relaxed import relaxed
from app.hyperedges.elastic.rounded_boxes import boxes_of
from app.hyperedges.elastic.run import Surroundings
from app.hyperedges.elastic.start import chains_of
from app.hyperedges.router import Progress, Routed, Router
from app.hyperedges.routing import Routing
from app.placement.placement import Placement


def elastic_router(placement: Placement, clearance: float, join_heights: Floats) -> Router:
    """Routes by relaxation: curves that keep ``clearance``, if they can, from each other and items.

    They leave attachments along their directions. ``join_heights`` (h,) are heights at which joins
    are held, NaN where they are free. A hyperedge may be within its own items only near where it
    attaches to them; what contains these is not in its way at all.
    """
    obstacles = obstacles_of(placement)
    boxes = boxes_of(obstacles, placement)

    def route(chosen: Indices, others: Routing, progress: Progress) -> Routed:
        curves = curves_of(others, len(chosen))
        part = placement.of_hyperedges(chosen)
        own = with_parts(part.attachment_items, part)
        around = Surroundings(
            Items.of(boxes, obstacles.items, containing_items(part), own),
            ItemsAround.of(part, obstacles, clearance),
            fixed_beside(curves, placement, chosen),
            curves,
            clearance,
        )
        chains, joins = chains_of(
            placement,
            chosen,
            join_heights[chosen],
            placement.stands and _on_ground(obstacles),
        )
        made = relaxed(chains, joins, around, progress)
        # Sweeps that are made after mending add no faults.
        is_proven = made.faults is not None and made.faults.count == 0
        return Routed(made.routing, is_proven, was_stopped=made.faults is None)

    return Router(True, route)


def _on_ground(obstacles: Obstacles) -> bool:
    """Whether all items stand on or above z = 0."""
    reach = np.einsum("kj,kj->k", np.abs(obstacles.rotations[:, 2]), obstacles.halves)
    return bool((obstacles.centers[:, 2] - reach - obstacles.roundings >= -1e-9).all())
