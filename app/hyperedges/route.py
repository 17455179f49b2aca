"""From a placement to a routing: a join plane for each hyperedge, then its curves."""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats
from app.hyperedges.curves import join_starts, lay_out, segment_starts
from app.hyperedges.join_planes import choose_join_planes
from app.hyperedges.routing import Routing
from app.placement.placement import Placement


def route(
    placement: Placement,
    *,
    curves: Literal["prose", "symbolic"] = "prose",
    fidelity: Literal["best", "paper"] = "best",
    closest: Literal["space", "plane"] = "space",
    clearance: float = 0.05,
    join_heights: Floats | None = None,
) -> Routing:
    """Curves of all hyperedges of a placement.

    ``curves`` is the reading of the paper; ``fidelity`` says whether exactly its curves are wanted
    ("paper") or ones that leave their items squarely ("best"); ``closest`` whether CLOSEST measures
    in three dimensions or as seen from above. ``join_heights`` (h,) are join planes, NaN where they
    are to be chosen with ``clearance`` in mind. Raises `ValueError` where a hyperedge has fewer
    than two attachments.
    """
    starts = placement.attachment_starts
    if join_heights is None:
        join_heights = np.full(len(starts) - 1, np.nan)
    join_planes = choose_join_planes(placement, clearance, join_heights)
    laid = lay_out(
        placement.attachment_positions,
        placement.attachment_directions,
        starts,
        join_planes,
        reading=curves,
        fidelity=fidelity,
        closest=closest,
    )
    return Routing(
        control_points=laid.control_points,
        segment_starts=segment_starts(starts),
        segment_ends=laid.ends,
        join_positions=laid.joins,
        join_tangents=laid.tangents,
        join_starts=join_starts(starts),
        join_planes=join_planes,
        radii=placement.radii,
    )
