"""Routings put together from routings of some of their hyperedges each."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.routing import Routing


def select(routing: Routing, chosen: Indices) -> Routing:
    """The hyperedges ``chosen`` (c,) of a routing, in that order, with all that is theirs."""
    segments = rows_of(routing.segment_starts, chosen)
    joins = rows_of(routing.join_starts, chosen)
    return Routing(
        control_points=routing.control_points[segments],
        segment_starts=starts_of(np.diff(routing.segment_starts)[chosen]),
        segment_ends=routing.segment_ends[segments],
        join_positions=routing.join_positions[joins],
        join_tangents=routing.join_tangents[joins],
        join_starts=starts_of(np.diff(routing.join_starts)[chosen]),
        join_planes=routing.join_planes[chosen],
        radii=routing.radii[chosen],
    )


def merge(first: Routing, second: Routing, places: Indices) -> Routing:
    """Both routings as one: hyperedge ``i`` of the first, then of the second, at ``places[i]``."""
    both = Routing(
        control_points=_both(first.control_points, second.control_points),
        segment_starts=_follow(first.segment_starts, second.segment_starts),
        segment_ends=np.concatenate([first.segment_ends, second.segment_ends]),
        join_positions=_both(first.join_positions, second.join_positions),
        join_tangents=_both(first.join_tangents, second.join_tangents),
        join_starts=_follow(first.join_starts, second.join_starts),
        join_planes=_both(first.join_planes, second.join_planes),
        radii=_both(first.radii, second.radii),
    )
    return select(both, np.argsort(places))


def _both(first: Floats, second: Floats) -> Floats:
    return np.concatenate([first, second])


def _follow(first: Indices, second: Indices) -> Indices:
    return np.concatenate([first, first[-1] + second[1:]])
