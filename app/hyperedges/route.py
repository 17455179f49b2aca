"""From a placement to a routing: short trees woven clear of each other, or the paper's CURVES."""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats
from app.hyperedges.clearance.box_tree import TooManyPairs
from app.hyperedges.curves import join_starts, lay_out, segment_starts
from app.hyperedges.elastic.limits import can_relax
from app.hyperedges.elastic.route import elastic_router
from app.hyperedges.join_planes import choose_join_planes
from app.hyperedges.previous import Previous, known_planes
from app.hyperedges.rerouting import reroute
from app.hyperedges.router import Progress
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import Allowance
from app.hyperedges.woven import lay_all, plane_router
from app.placement.placement import Placement

ROUTERS = {
    "planes": (plane_router,),
    "elastic": (elastic_router,),
    "auto": (elastic_router, plane_router),
}
"""The routers of each kind of routing, the first of which is preferred."""


def route(
    placement: Placement,
    *,
    curves: Literal["steiner", "prose", "symbolic"] = "steiner",
    fidelity: Literal["best", "paper"] = "best",
    closest: Literal["space", "plane"] = "space",
    clearance: float | None = 0.05,
    routing: Literal["planes", "elastic", "auto"] = "planes",
    join_heights: Floats | None = None,
    previous: Previous | None = None,
    progress: Progress = lambda _share: None,
    allowance: Allowance | None = None,
) -> Routing:
    """Curves of all hyperedges of a placement.

    ``curves`` says whether they are short trees (``steiner``) or follow one of the two readings of
    the paper. Short trees are woven so that tubes keep ``clearance`` from each other and from items
    wherever that is possible, and so that no curve bends more tightly than 1.5 times its tube's
    radius; without a clearance (None) each is laid for itself. ``routing`` says how: in ``planes``
    (`app.hyperedges.woven`), by ``elastic`` relaxation (`app.hyperedges.elastic`), or as ``auto``
    by the one of the two that leaves fewer faults. What is too large for relaxation, or too dense,
    goes in planes (`app.hyperedges.elastic.limits`, `MOST_NEAR`). With a ``previous`` layout
    whatever is not new stays where it is, unless it is in the way.

    Of the paper's curves, ``fidelity`` says whether exactly they are wanted ("paper") or ones that
    leave their items squarely ("best"); ``closest`` whether CLOSEST measures in three dimensions or
    as seen from above. They get join planes with ``clearance`` in mind, but nobody moves them;
    those of a ``previous`` layout keep their planes.

    ``join_heights`` (h,) are join planes, NaN where they are to be chosen. ``progress`` is told
    shares of the work; where it raises `app.hyperedges.stopping.StoppedError`, what comes of it are
    the best short trees so far. Of the time that ``allowance`` has, ``auto`` leaves some for either
    way. Raises `ValueError` where a hyperedge has fewer than two attachments.
    """
    starts = placement.attachment_starts
    allowance = allowance or Allowance()
    if join_heights is None:
        join_heights = np.full(len(starts) - 1, np.nan)
    if previous is not None and (curves != "steiner" or clearance is None):
        join_heights = known_planes(placement, join_heights, previous)
    if curves == "steiner":
        if clearance is None:
            return lay_all(placement, join_heights)
        kinds = ROUTERS[routing] if can_relax(placement, clearance) else ROUTERS["planes"]
        if routing == "auto" and not np.isnan(join_heights).all():
            kinds = ROUTERS["planes"]
        if not placement.stands and kinds == ROUTERS["auto"]:
            # There is no ground to have heights over.
            kinds = ROUTERS["elastic"]
        routers = [kind(placement, clearance, join_heights) for kind in kinds]
        try:
            return reroute(
                placement, clearance, join_heights, routers, previous, progress, allowance
            )
        except TooManyPairs:
            planes = [plane_router(placement, clearance, join_heights)]
            return reroute(
                placement, clearance, join_heights, planes, previous, progress, allowance
            )
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
