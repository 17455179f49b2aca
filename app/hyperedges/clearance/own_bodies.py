"""Where a hyperedge may touch an item that it attaches to: within a ball about its attachment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.grouped import rows_from, starts_of
from app.hyperedges.clearance.obstacles import Obstacles
from app.hyperedges.clearance.passable import with_parts
from app.placement.placement import Placement
from app.solids.solid import Csg

LEAVING = 3.0
"""Radius of the ball, over the tube's radius and the clearance: a straight tube that leaves a face
at 20 degrees or more is clear of it outside the ball."""

HALVINGS = 8
"""How finely curves are cut where they pass through the ball's surface. What is left undecided then
counts as outside."""

SHRINK = 1.0 - 1e-9
"""Rounding makes the ball no larger."""


def leaving_radii(placement: Placement, bodies: Obstacles, clearance: float) -> Floats:
    """Radii (a,) of the balls, in document units.

    An attachment within its item's body has a ball that is larger by its depth: the distance to the
    surface of the box that it is deepest in. What is made of simple solids may be hollow: there it
    is the way out of the box along the attachment's direction.
    """
    counts = np.diff(placement.attachment_starts)
    radii = LEAVING * (np.repeat(placement.radii, counts) + clearance)
    firsts = np.searchsorted(bodies.items, placement.attachment_items, side="left")
    boxes_of_each = np.searchsorted(bodies.items, placement.attachment_items, side="right") - firsts
    rows = rows_from(firsts, boxes_of_each)
    owners = np.repeat(np.arange(len(radii)), boxes_of_each)
    away = placement.attachment_positions[owners] - bodies.centers[rows]
    local = np.abs(np.einsum("kij,ki->kj", bodies.rotations[rows], away))
    within = (bodies.halves[rows] - local).min(axis=1, initial=np.inf)
    beyond = np.linalg.norm(np.maximum(local - bodies.halves[rows], 0.0), axis=1)
    depths = np.maximum(within, 0.0) + np.maximum(bodies.roundings[rows] - beyond, 0.0)
    is_csg = np.array([isinstance(solid, Csg) for solid in placement.solids], dtype=np.bool_)
    hollow = np.flatnonzero(is_csg[bodies.items[rows]] & (within > 0.0))
    if len(hollow):
        box = rows[hollow]
        outward = placement.attachment_directions[owners[hollow]]
        place, way = (
            np.einsum("kij,ki->kj", bodies.rotations[box], vector)
            for vector in (away[hollow], outward)
        )
        steps = (bodies.halves[box] - place * np.sign(way)) / np.maximum(np.abs(way), 1e-9)
        depths[hollow] = steps.min(axis=1)
    deepest = np.zeros(len(radii))
    np.maximum.at(deepest, owners, depths)
    return np.asarray(radii + deepest)


def beyond_own_balls(
    control_points: Floats, named: Indices, placement: Placement, radii: Floats
) -> tuple[Floats, Indices]:
    """What of some curves is outside the balls of their hyperedge's attachments to an item.

    ``control_points`` (p, 4, 3) of curves, and for each the hyperedge and the item, ``named``
    (p, 2); ``radii`` (a,) of the balls. Returns pieces (q, 4, 3) that cover all that is outside,
    and a little more, and the number of each one's curve (q,), ascending.
    """
    counts = np.diff(placement.attachment_starts)
    rows, items = with_parts(placement.attachment_items, placement)
    count = int(items.max(initial=0)) + 1
    keys = np.repeat(np.arange(len(counts)), counts)[rows] * count + items
    order = np.argsort(keys, kind="stable")
    wanted = named[:, 0] * count + named[:, 1]
    firsts = np.searchsorted(keys[order], wanted, side="left")
    balls_of_each = np.searchsorted(keys[order], wanted, side="right") - firsts
    balls = rows[order[rows_from(firsts, balls_of_each)]]
    return _cut(
        control_points,
        placement.attachment_positions[balls],
        radii[balls],
        starts_of(balls_of_each),
    )


def _cut(curves: Floats, centers: Floats, radii: Floats, starts: Indices) -> tuple[Floats, Indices]:
    """Pieces of ``curves`` (p, 4, 3) beyond their balls, ``starts[i]`` to ``starts[i + 1]``."""
    numbers = np.arange(len(curves))
    kept, kept_numbers = [np.zeros((0, 4, 3))], [np.zeros(0, dtype=np.int64)]
    for halving in range(HALVINGS + 1):
        inside, outside = _compare(curves, numbers, centers, radii, starts)
        keep = ~inside if halving == HALVINGS else outside
        kept.append(curves[keep])
        kept_numbers.append(numbers[keep])
        rest = ~(inside | keep)
        curves, numbers = _halved(curves[rest]), np.repeat(numbers[rest], 2)
        if len(curves) == 0:
            break
    found = np.concatenate(kept_numbers)
    order = np.argsort(found, kind="stable")
    return np.concatenate(kept)[order], found[order]


def _compare(
    curves: Floats, numbers: Indices, centers: Floats, radii: Floats, starts: Indices
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which curves are inside one of their balls, and which are outside all of them.

    A curve is in the hull of its control points: inside where these are, outside where the box
    around them is.
    """
    inside = np.zeros(len(curves), dtype=np.bool_)
    outside = np.ones(len(curves), dtype=np.bool_)
    lows, highs = curves.min(axis=1), curves.max(axis=1)
    balls_of_each = np.diff(starts)[numbers]
    for rank in range(int(balls_of_each.max(initial=0))):
        asked = np.flatnonzero(balls_of_each > rank)
        ball = starts[numbers[asked]] + rank
        away = np.linalg.norm(curves[asked] - centers[ball][:, None], axis=2)
        inside[asked] |= (away <= SHRINK * radii[ball][:, None]).all(axis=1)
        nearest = np.clip(centers[ball], lows[asked], highs[asked])
        outside[asked] &= np.linalg.norm(nearest - centers[ball], axis=1) >= radii[ball]
    return inside, outside


def _halved(curves: Floats) -> Floats:
    """Both halves of each curve, one after the other, by de Casteljau: (2 p, 4, 3)."""
    a, b, c, d = curves.transpose(1, 0, 2)
    ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
    abc, bcd = (ab + bc) / 2, (bc + cd) / 2
    middle = (abc + bcd) / 2
    first = np.stack([a, ab, abc, middle], axis=1)
    second = np.stack([middle, bcd, cd, d], axis=1)
    return np.stack([first, second], axis=1).reshape(-1, 4, 3)
