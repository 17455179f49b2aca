"""An earlier layout, and which hyperedges may keep their curves in it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_from, rows_of
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.clearance.obstacle_gaps import obstacle_gaps
from app.hyperedges.clearance.obstacles import Obstacles, obstacles_of
from app.hyperedges.routing import Routing
from app.placement.placement import Placement


@dataclass(frozen=True, slots=True, eq=False)
class Previous:
    """An earlier layout: its placement and its routing.

    ``numbers`` (h,): which of its hyperedges each hyperedge of the program was, -1 for new ones.
    """

    placement: Placement
    routing: Routing
    numbers: Indices


def keepable(
    placement: Placement, clearance: float, join_heights: Floats, previous: Previous
) -> Flags:
    """Which hyperedges (h,) can keep their curves: unmoved, and with nothing new in their way."""
    kept = unmoved(placement, join_heights, previous)
    hyperedges = np.flatnonzero(kept)
    kept[hyperedges[_obstructed(placement, clearance, previous, hyperedges)]] = False
    return kept


def known_planes(placement: Placement, join_heights: Floats, previous: Previous) -> Floats:
    """Join planes (h,) as ``join_heights`` wish, and else those of before for what has not moved.

    NaN where one is to be chosen.
    """
    same = unmoved(placement, join_heights, previous) & np.isnan(join_heights)
    planes = join_heights.copy()
    planes[same] = previous.routing.join_planes[previous.numbers[same]]
    return planes


def unmoved(placement: Placement, join_heights: Floats, previous: Previous) -> Flags:
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


def _obstructed(
    placement: Placement, clearance: float, previous: Previous, hyperedges: Indices
) -> Indices:
    """Which of the ``hyperedges`` (k,), by their rows, items obstruct that did not do so before.

    Items that are new or have moved, and those that a hyperedge may no longer touch or pass. What
    is too near to something for long was so when nothing better was found.
    """
    if len(hyperedges) == 0:
        return hyperedges
    obstacles, old_obstacles = obstacles_of(placement), obstacles_of(previous.placement)
    numbers = previous.numbers[hyperedges]
    part, old_part = placement.of_hyperedges(hyperedges), previous.placement.of_hyperedges(numbers)
    if _are_same(obstacles, old_obstacles) and _attach_alike(part, old_part):
        return np.zeros(0, dtype=np.int64)
    boxes, old_boxes = _numbered(obstacles, old_obstacles)
    new = np.flatnonzero(~np.isin(boxes, old_boxes))
    around = ItemsAround.of(part, obstacles, clearance)
    before = ItemsAround.of(old_part, old_obstacles, clearance)
    count = max(int(boxes.max(initial=0)), int(old_boxes.max(initial=0))) + 1
    other = [
        np.setxor1d(
            _named(pairs, obstacles.items, boxes, count),
            _named(old_pairs, old_obstacles.items, old_boxes, count),
        )
        // count
        for pairs, old_pairs in (
            (around.attached, before.attached),
            (around.containing, before.containing),
        )
    ]
    curves = previous.routing.part(numbers)
    asked = np.zeros(len(hyperedges), dtype=np.bool_)
    asked[np.concatenate(other)] = True
    everyone = np.ones(len(hyperedges), dtype=np.bool_)
    beside_new = replace(around, obstacles=obstacles.only(new))
    found = np.concatenate(
        [
            _conflicts(curves, beside_new, boxes[new], everyone),
            _conflicts(curves, around, boxes, asked),
        ]
    )
    if len(found) == 0:
        return np.zeros(0, dtype=np.int64)
    asked = np.zeros(len(hyperedges), dtype=np.bool_)
    asked[found[:, 0]] = True
    known = _conflicts(curves, before, old_boxes, asked)
    keys, known_keys = (pairs[:, 0] * count + pairs[:, 1] for pairs in (found, known))
    return np.unique(found[~np.isin(keys, known_keys), 0])


def _are_same(obstacles: Obstacles, old: Obstacles) -> bool:
    """Whether all boxes are the same, of items of the same numbers."""
    return all(
        np.array_equal(getattr(obstacles, name), getattr(old, name))
        for name in ("items", "centers", "rotations", "halves", "roundings", "is_label")
    )


def _attach_alike(placement: Placement, old: Placement) -> bool:
    """Whether all hyperedges attach to items of the same numbers, which are parts of the same."""
    return np.array_equal(placement.parents, old.parents) and np.array_equal(
        placement.attachment_items, old.attachment_items
    )


def _conflicts(curves: Routing, around: ItemsAround, boxes: Indices, asked: Flags) -> Indices:
    """Pairs (n, 2) of one of the hyperedges ``asked`` (k,) and one of ``boxes`` too near to it."""
    if len(boxes) == 0 or not asked.any():
        return np.zeros((0, 2), dtype=np.int64)
    owners = np.repeat(np.arange(len(curves.radii)), np.diff(curves.segment_starts))
    near = around.near(
        curves.control_points, owners, curves.radii[owners], around.clearance, asked[owners]
    )
    gaps = obstacle_gaps(near.points, near.radii, around.obstacles, near.pairs, around.clearance)
    close = near.pairs[gaps.lower < around.clearance]
    return np.stack([near.owners[close[:, 0]], boxes[close[:, 1]]], axis=1)


def _numbered(obstacles: Obstacles, old: Obstacles) -> tuple[Indices, Indices]:
    """The boxes of both as numbers, (m,) and (n,), which are the same for boxes that are."""
    rows = np.concatenate(
        [
            np.concatenate(
                [
                    some.centers,
                    some.rotations.reshape(-1, 9),
                    some.halves,
                    some.roundings[:, None],
                ],
                axis=1,
            )
            for some in (obstacles, old)
        ]
    )
    if len(rows) == 0:
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    as_bytes = np.ascontiguousarray(rows).view(np.dtype((np.void, rows.itemsize * 16))).ravel()
    numbers = np.unique(as_bytes, return_inverse=True)[1]
    return numbers[: len(obstacles.items)], numbers[len(obstacles.items) :]


def _named(pairs: Indices, items: Indices, boxes: Indices, count: int) -> Indices:
    """Pairs (k, 2) of a hyperedge and an item as numbers of a hyperedge and each of its boxes."""
    firsts = np.searchsorted(items, pairs[:, 1], side="left")
    counts = np.searchsorted(items, pairs[:, 1], side="right") - firsts
    return np.repeat(pairs[:, 0], counts) * count + boxes[rows_from(firsts, counts)]
