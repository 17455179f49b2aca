"""Curves of all hyperedges of a placement by relaxation, beside those that are kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.clearance.passable import containing_items, passable_items, with_parts
from app.hyperedges.elastic.fixed import curves_of, fixed_beside
from app.hyperedges.elastic.neighbours import Items
from app.hyperedges.elastic.relaxed import Progress, relaxed
from app.hyperedges.elastic.repair import Mended
from app.hyperedges.elastic.rounded_boxes import Boxes, boxes_of
from app.hyperedges.elastic.run import Surroundings
from app.hyperedges.elastic.start import chains_of
from app.hyperedges.joining import merge, select
from app.hyperedges.routing import Routing
from app.hyperedges.woven import Previous, ending_together, new_obstacles, too_near, unmoved
from app.placement.placement import Placement

HITS = 3
"""How often hyperedges that an edit hits are routed anew with it, before all are."""


def route_elastic(
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    previous: Previous | None = None,
    progress: Progress = lambda _share: None,
) -> Routing:
    """Curves of all hyperedges that keep ``clearance``, if they can, from each other and items.

    They leave attachments along their directions. ``join_heights`` (h,) are heights at which joins
    are held, NaN where they are free. Hyperedges of a ``previous`` layout keep their curves to the
    last bit unless their attachments moved, or they are in the way of what is new.

    A hyperedge may be within its own items only near where it attaches to them; what contains these
    is not in its way at all.
    """
    obstacles = obstacles_of(placement)
    boxes = boxes_of(obstacles, placement)
    kept = np.zeros(len(placement.radii), dtype=np.bool_)
    if previous is not None:
        kept = unmoved(placement, join_heights, previous)
        new = new_obstacles(obstacles, previous.placement)
        kept &= ~too_near(kept, placement, previous, new, passable_items(placement), clearance)
        if kept.all():
            return select(previous.routing, previous.numbers)
    best: tuple[Mended, Flags] | None = None
    for attempt in range(HITS + 1):
        if attempt == HITS:
            kept = np.zeros_like(kept)
        chosen, standing = np.flatnonzero(~kept), np.flatnonzero(kept)
        old = None if previous is None else select(previous.routing, previous.numbers[standing])
        made = _beside(
            placement,
            clearance,
            join_heights,
            chosen,
            old,
            boxes,
            obstacles,
            progress,
        )
        if best is None or made.faults.count < best[0].faults.count:
            best = made, kept
        hit = standing[np.unique(made.faults.hit) - len(chosen)]
        hit = hit[~ending_together(placement, hit, kept)]
        if len(hit) == 0:
            break
        kept = kept.copy()
        kept[hit] = False
    assert best is not None, "there is one attempt at least"  # noqa: S101
    made, kept = best
    standing = np.flatnonzero(kept)
    if previous is None or len(standing) == 0:
        return made.routing
    old = select(previous.routing, previous.numbers[standing])
    return merge(made.routing, old, np.concatenate([np.flatnonzero(~kept), standing]))


def _beside(
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    chosen: Indices,
    old: Routing | None,
    boxes: Boxes,
    obstacles: Obstacles,
    progress: Progress,
) -> Mended:
    """Curves of the hyperedges ``chosen`` (k,), beside the ``old`` ones of all others."""
    none = np.zeros(0, dtype=np.int64)
    curves = curves_of(old or select(_nothing(), none), len(chosen))
    part = _part(placement, chosen)
    own = with_parts(part.attachment_items, part)
    around = Surroundings(
        Items.of(boxes, obstacles.items, containing_items(part), own),
        ItemsAround.of(part, obstacles, clearance),
        fixed_beside(curves, placement, chosen),
        curves,
        clearance,
    )
    chains, joins = chains_of(placement, chosen, join_heights[chosen], _on_ground(obstacles))
    return relaxed(chains, joins, around, progress)


def _part(placement: Placement, chosen: Indices) -> Placement:
    """The placement with the hyperedges ``chosen`` (c,) alone."""
    rows = rows_of(placement.attachment_starts, chosen)
    return replace(
        placement,
        attachment_positions=placement.attachment_positions[rows],
        attachment_directions=placement.attachment_directions[rows],
        attachment_starts=starts_of(np.diff(placement.attachment_starts)[chosen]),
        attachment_items=placement.attachment_items[rows],
        radii=placement.radii[chosen],
    )


def _nothing() -> Routing:
    none, places = np.zeros(1, dtype=np.int64), np.zeros((0, 3))
    return Routing(
        np.zeros((0, 4, 3)),
        none,
        np.zeros((0, 2), dtype=np.int64),
        places,
        places,
        none,
        np.zeros(0),
        np.zeros(0),
    )


def _on_ground(obstacles: Obstacles) -> bool:
    """Whether all items stand on or above z = 0."""
    reach = np.einsum("kj,kj->k", np.abs(obstacles.rotations[:, 2]), obstacles.halves)
    return bool((obstacles.centers[:, 2] - reach - obstacles.roundings >= -1e-9).all())
