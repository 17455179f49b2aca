"""Items as obstacles, and hyperedges by their control points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.placement.placement import LabelPlace, Placement
from app.placement.turning import UPRIGHT
from app.solids.extents import size_of
from app.solids.solid import Solid, Text


def label(text: str, position: tuple[float, float, float]) -> LabelPlace:
    letters = Text(text, 0.3, 0.07)
    return LabelPlace(letters, position, UPRIGHT, size_of(letters))


def furnished(
    solids: Sequence[Solid],
    centers: Floats | list[list[float]],
    *,
    labels: Sequence[LabelPlace | None] | None = None,
    rotations: Floats | None = None,
    attachments: Sequence[Sequence[int]] = (),
    radius: float = 0.1,
) -> Placement:
    """Items, and hyperedges by the items that they attach to, in the middle of their tops."""
    middles, count = np.array(centers, dtype=np.float64).reshape(-1, 3), len(solids)
    items = np.array([item for ends in attachments for item in ends], dtype=np.int64)
    sizes = np.array([size_of(solid) for solid in solids]).reshape(-1, 3)
    return Placement(
        centers=middles,
        rotations=np.tile([0.0, 0, 0, 1], (count, 1)) if rotations is None else rotations,
        sizes=sizes,
        solids=tuple(solids),
        labels=(None,) * count if labels is None else tuple(labels),
        attachment_positions=middles[items] + sizes[items] * [0, 0, 0.5],
        attachment_directions=np.tile([0.0, 0, 1], (len(items), 1)),
        attachment_starts=np.cumsum([0, *(len(ends) for ends in attachments)]),
        attachment_items=items,
        radii=np.full(len(attachments), radius),
    )


def routed(
    hyperedges: Sequence[Sequence[Floats]],
    *,
    ends: Sequence[Sequence[tuple[int, int]]] | None = None,
    joins: Sequence[int] | None = None,
    radius: float = 0.1,
) -> Routing:
    """Hyperedges of given segments: chains, unless ``ends`` and how many ``joins`` are told."""
    counts = [len(segments) for segments in hyperedges]
    if ends is None or joins is None:
        # Attachments 0 and 1, then bends.
        ends = [
            [(0 if k == 0 else k + 1, 1 if k == count - 1 else k + 2) for k in range(count)]
            for count in counts
        ]
        joins = [count - 1 for count in counts]
    flat = [end for some in ends for end in some]
    rows = sum(joins)
    return Routing(
        control_points=np.array([s for some in hyperedges for s in some]).reshape(-1, 4, 3),
        segment_starts=np.cumsum([0, *counts]),
        segment_ends=np.array(flat, dtype=np.int64).reshape(-1, 2),
        join_positions=np.zeros((rows, 3)),
        join_tangents=np.tile([1.0, 0, 0], (rows, 1)),
        join_starts=np.cumsum([0, *joins]),
        join_planes=np.zeros(len(counts)),
        radii=np.full(len(counts), radius),
    )
