"""A routing put together from two of some of its hyperedges each."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing


def merge(first: Routing, second: Routing, places: Indices) -> Routing:
    """Both routings as one: hyperedge ``i`` of the first, then of the second, at ``places[i]``.

    It is elastic if the first is.
    """
    both = Routing(
        control_points=_both(first.control_points, second.control_points),
        segment_starts=_follow(first.segment_starts, second.segment_starts),
        segment_ends=np.concatenate([first.segment_ends, second.segment_ends]),
        join_positions=_both(first.join_positions, second.join_positions),
        join_tangents=_both(first.join_tangents, second.join_tangents),
        join_starts=_follow(first.join_starts, second.join_starts),
        join_planes=_both(first.join_planes, second.join_planes),
        radii=_both(first.radii, second.radii),
        is_elastic=first.is_elastic,
    )
    return both.part(np.argsort(places))


def _both(first: Floats, second: Floats) -> Floats:
    return np.concatenate([first, second])


def _follow(first: Indices, second: Indices) -> Indices:
    return np.concatenate([first, first[-1] + second[1:]])
