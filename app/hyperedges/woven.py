"""Routings of the ``steiner`` kind: short trees, woven so that they keep clear of each other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.clearance.obstacles import (
    Obstacles,
    near_obstacles,
    obstacle_gaps,
    obstacles_of,
)
from app.hyperedges.clearance.passable import passable_items
from app.hyperedges.join_planes import choose_join_planes
from app.hyperedges.joining import merge, select
from app.hyperedges.routing import Routing
from app.hyperedges.weaving.faults import TOLERANCE
from app.hyperedges.weaving.loose import lay_loosely
from app.hyperedges.weaving.numbering import number
from app.hyperedges.weaving.plan import feet_of
from app.hyperedges.weaving.threads import Still, Surroundings, Threads
from app.hyperedges.weaving.weave import Progress, Weave, weave
from app.placement.placement import Placement

ARCH = 1.5
"""Height of a plane above its attachments, over the root of span times radius.

With tubes of radius 0.08, a quarter of a span of three units, and an eighth of one of fifteen.
"""

LEAST_RISE = 4.0
"""Least height in radii: a bend and its way back."""

HITS = 3
"""How often hyperedges that an edit hits are woven anew with it, before all are, if that helps."""


@dataclass(frozen=True, slots=True, eq=False)
class Previous:
    """An earlier layout: its placement and its routing.

    ``numbers`` (h,): which of its hyperedges each hyperedge of the program was, -1 for new ones.
    """

    placement: Placement
    routing: Routing
    numbers: Indices


def weave_all(
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    previous: Previous | None = None,
    progress: Progress = lambda _share: None,
) -> Routing:
    """Curves of all hyperedges that keep ``clearance``, if they can, from each other and items.

    ``join_heights`` (h,) are join planes, NaN where they are to be chosen. Hyperedges of a
    ``previous`` layout keep their curves to the last bit unless their attachments moved, or they
    are in the way of what is new.
    """
    surroundings = Surroundings.of(obstacles_of(placement), passable_items(placement))
    kept = np.zeros(len(placement.radii), dtype=np.bool_)
    if previous is not None:
        kept = unmoved(placement, join_heights, previous)
        new = new_obstacles(surroundings.obstacles, previous.placement)
        kept &= ~too_near(kept, placement, previous, new, surroundings.attached, clearance)
        if kept.all():
            return select(previous.routing, previous.numbers)
    best: tuple[Weave, Floats, NDArray[np.bool_]] | None = None
    for attempt in range(HITS + 1):
        if attempt == HITS:
            kept = np.zeros_like(kept)
        woven, radii = _weave_beside(
            kept, placement, clearance, join_heights, surroundings, previous, progress
        )
        # Where all are woven anew, it must be worth it.
        if best is None or woven.faults < best[0].faults or attempt < HITS:
            best = woven, radii, kept
        hit = np.flatnonzero(kept)[woven.hit]
        hit = hit[~ending_together(placement, hit, kept)]
        if len(hit) == 0:
            break
        kept = kept.copy()
        kept[hit] = False
    assert best is not None, "there is one attempt at least"  # noqa: S101
    woven, radii, kept = best
    made = number(woven.plan, woven.fabric, woven.leaving, woven.planes, radii)
    old = _standing(previous, np.flatnonzero(kept))
    if old is None:
        return made
    return merge(made, old, np.concatenate([np.flatnonzero(~kept), np.flatnonzero(kept)]))


def _weave_beside(
    kept: NDArray[np.bool_],
    placement: Placement,
    clearance: float,
    join_heights: Floats,
    surroundings: Surroundings,
    previous: Previous | None,
    progress: Progress,
) -> tuple[Weave, Floats]:
    """Curves of the hyperedges that are not ``kept`` (h,), and their radii."""
    chosen, standing = np.flatnonzero(~kept), np.flatnonzero(kept)
    old = _standing(previous, standing)
    threads = _threads(placement, clearance, join_heights, chosen)
    still = Still.nothing() if old is None else _still(placement, standing, old)
    renumbered = np.empty(len(kept), dtype=np.int64)
    renumbered[np.concatenate([chosen, standing])] = np.arange(len(kept))
    attached = surroundings.attached.copy()
    attached[:, 0] = renumbered[attached[:, 0]]
    attached = attached[np.lexsort((attached[:, 1], attached[:, 0]))]
    around = replace(surroundings, attached=attached)
    return weave(threads, still, around, clearance, progress), threads.radii


def ending_together(
    placement: Placement, hit: Indices, kept: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which of the hyperedges ``hit`` (m,) end where one does that is not ``kept`` (h,).

    They touch there however they run: to weave them anew would move them for nothing.
    """
    starts = placement.attachment_starts
    places = np.ascontiguousarray(placement.attachment_positions).view("V24").ravel()
    rows = rows_of(starts, hit)
    shared = np.isin(places[rows], places[rows_of(starts, np.flatnonzero(~kept))])
    counts = np.diff(starts)[hit]
    found = np.zeros(len(hit), dtype=np.bool_)
    found[np.repeat(np.arange(len(hit)), counts)[shared]] = True
    return found


def known_planes(placement: Placement, join_heights: Floats, previous: Previous) -> Floats:
    """Join planes (h,) as ``join_heights`` wish, and else those of before for what has not moved.

    NaN where one is to be chosen.
    """
    same = unmoved(placement, join_heights, previous) & np.isnan(join_heights)
    planes = join_heights.copy()
    planes[same] = previous.routing.join_planes[previous.numbers[same]]
    return planes


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


def unmoved(placement: Placement, join_heights: Floats, previous: Previous) -> NDArray[np.bool_]:
    """Which hyperedges (h,) attach where they did, with tubes as thick."""
    old = previous.placement
    same = previous.numbers >= 0
    numbers = np.maximum(previous.numbers, 0)
    if not same.any():
        return same
    counts, old_counts = np.diff(placement.attachment_starts), np.diff(old.attachment_starts)
    same &= counts == old_counts[numbers]
    same &= placement.radii == old.radii[numbers]
    same &= np.isnan(join_heights) | (join_heights == previous.routing.join_planes[numbers])
    here = rows_of(placement.attachment_starts, np.flatnonzero(same))
    there = rows_of(old.attachment_starts, numbers[same])
    equal = (placement.attachment_positions[here] == old.attachment_positions[there]).all(axis=1)
    equal &= (placement.attachment_directions[here] == old.attachment_directions[there]).all(axis=1)
    moved = np.repeat(np.flatnonzero(same), counts[same])[~equal]
    same[moved] = False
    return same


def _standing(previous: Previous | None, standing: Indices) -> Routing | None:
    if previous is None or len(standing) == 0:
        return None
    return select(previous.routing, previous.numbers[standing])


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


def new_obstacles(obstacles: Obstacles, placement: Placement) -> Obstacles:
    """The boxes that were not in an earlier placement."""
    old = obstacles_of(placement)
    return obstacles.only(np.flatnonzero(~np.isin(_bytes(obstacles), _bytes(old))))


def _bytes(obstacles: Obstacles) -> NDArray[np.void]:
    """Each box as a string of bytes, (m,)."""
    rows = np.concatenate(
        [
            obstacles.centers,
            obstacles.rotations.reshape(-1, 9),
            obstacles.halves,
            obstacles.roundings[:, None],
        ],
        axis=1,
    )
    return np.ascontiguousarray(rows).view(np.dtype((np.void, rows.itemsize * 16))).ravel()


def too_near(
    kept: NDArray[np.bool_],
    placement: Placement,
    previous: Previous,
    new: Obstacles,
    attached: Indices,
    clearance: float,
) -> NDArray[np.bool_]:
    """Which of the hyperedges that are kept are too near to ``new`` items, (h,).

    Those that are too near to each other were so before, when nothing better was found.
    """
    found = np.zeros(len(kept), dtype=np.bool_)
    standing = np.flatnonzero(kept)
    old = _standing(previous, standing)
    if old is None or len(new.items) == 0:
        return found
    owners = np.repeat(standing, np.diff(old.segment_starts))
    radii = placement.radii[owners]
    near = near_obstacles(old.control_points, owners, radii, new, attached, clearance)
    gaps = obstacle_gaps(old.control_points, radii, new, near, clearance, TOLERANCE)
    found[owners[near[gaps.lower < clearance, 0]]] = True
    return found
