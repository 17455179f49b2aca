"""How high each hyperedge rises: its join plane, where the document does not say.

An arch looks right when its height relates to its span, long ones flatter. From there upwards each
hyperedge takes the lowest level that no other has whose footprint, its box seen from above,
overlaps its own; short hyperedges choose first, so that long ones pass above them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.footprints import highest_below, plant
from app.hyperedges.levels import LEVELS, assign
from app.placement.placement import Placement

ARCH = 2.0
"""Height of a join plane above its attachments, over the root of span times radius.

With tubes of radius 0.08, a third of a span of three units, and a sixth of one of fifteen.
"""

ARCH_OF_JOINS = 1.5
"""The same where there are joins: such curves rise above their plane, others stay below it."""

LEAST_RISE = 4.0
"""Least height in radii: a bend and its way back."""

PEAK = 0.75
"""A curve between two attachments reaches this share of its join plane's height above them."""


def choose_join_planes(
    placement: Placement, clearance: float | None, join_heights: Floats
) -> Floats:
    """Join planes (h,), world z: ``join_heights`` (h,) where they are numbers, else chosen.

    Levels lie as far apart as makes the peaks of curves between two attachments clear each other.
    Hyperedges whose footprints overlap get different levels, unless more than `LEVELS` do; without
    a ``clearance`` nobody looks whether they overlap, and each is as high as looks right.
    """
    chosen = np.isnan(join_heights)
    if not chosen.any():
        return join_heights.copy()
    is_alone = clearance is None
    clearance = clearance or 0.0
    starts = placement.attachment_starts
    at = placement.attachment_positions
    lows = np.minimum.reduceat(at, starts[:-1], axis=0)
    highs = np.maximum.reduceat(at, starts[:-1], axis=0)
    radii = placement.radii
    spacing = (2.0 * float(radii.max()) + clearance) / PEAK
    footprints = _rectangles(lows, highs, radii + clearance / 2.0)
    wished = _wished_heights(placement, clearance, lows, highs, footprints)
    if is_alone:
        return np.where(chosen, wished, join_heights)
    wishes = _levels(np.where(chosen, wished, join_heights) / spacing, chosen)
    given = np.ceil(np.where(chosen, 0.0, join_heights) / spacing).astype(np.int64)
    tops = np.where(chosen, wishes + LEVELS - 1, given)
    spans = np.hypot(highs[:, 0] - lows[:, 0], highs[:, 1] - lows[:, 1])
    order = np.lexsort((spans, wishes))
    levels = assign(plant(footprints), wishes, tops, order[chosen[order]])
    return np.where(chosen, levels * spacing, join_heights)


def _levels(heights: Floats, chosen: NDArray[np.bool_]) -> Indices:
    """The level at or above what is to be chosen, at or below what is given."""
    return np.asarray(np.where(chosen, np.ceil(heights), np.floor(heights)).astype(np.int64))


def _rectangles(lows: Floats, highs: Floats, margins: Floats) -> Floats:
    """Footprints (n, 4) of boxes with margins (n,)."""
    return np.stack(
        [
            lows[:, 0] - margins,
            highs[:, 0] + margins,
            lows[:, 1] - margins,
            highs[:, 1] + margins,
        ],
        axis=1,
    )


def _wished_heights(
    placement: Placement, clearance: float, lows: Floats, highs: Floats, footprints: Floats
) -> Floats:
    """Heights (h,) at which arches look right, above their attachments and items under them."""
    radii = placement.radii
    spans = np.hypot(highs[:, 0] - lows[:, 0], highs[:, 1] - lows[:, 1])
    joined = np.diff(placement.attachment_starts) > 2
    arches = np.where(joined, ARCH_OF_JOINS, ARCH) * np.sqrt(spans * radii)
    rises = np.maximum(arches, LEAST_RISE * radii + clearance)
    tops = highs[:, 2]
    if len(placement.centers) == 0:
        return np.asarray(tops + rises)
    item_lows, item_highs = _boxes(placement)
    items = plant(_rectangles(item_lows, item_highs, np.zeros(len(item_lows))))
    obstacles = highest_below(items, np.ascontiguousarray(item_highs[:, 2]), footprints)
    # Where the curve peaks it clears what is under it; towers are not jumped but gone around.
    bases = lows[:, 2]
    needed = np.minimum((obstacles - bases + radii + clearance) / PEAK, rises + spans)
    return np.asarray(np.maximum(tops + rises, bases + needed))


def _boxes(placement: Placement) -> tuple[Floats, Floats]:
    """Smallest and largest corners (n, 3) of the items, turned as they are."""
    x, y, z, w = placement.rotations.T
    turned = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    reach = np.einsum("ijn,nj->ni", np.abs(turned), placement.sizes) / 2.0
    return placement.centers - reach, placement.centers + reach
