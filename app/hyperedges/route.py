"""From a placement to a routing: join planes, then curves."""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats
from app.hyperedges.curves import lay_out
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
    """Curves for all hyperedges of a placement.

    ``curves`` is the reading of the paper, ``fidelity`` whether exactly its curves are wanted
    (``paper``) or ones that leave their items squarely (``best``), ``closest`` whether CLOSEST
    measures in three dimensions or seen from above. ``join_heights`` (h,) are the join planes, NaN
    where they are to be chosen with ``clearance`` in mind.
    """
    starts = placement.attachment_starts
    planes = np.full(len(starts) - 1, np.nan) if join_heights is None else join_heights.copy()
    free = np.isnan(planes)
    if free.any():
        reach = _half_extents(placement.rotations, placement.sizes)
        chosen = choose_join_planes(
            placement.attachment_positions,
            starts,
            placement.radii,
            clearance,
            placement.centers - reach,
            placement.centers + reach,
        )
        planes[free] = chosen[free]
    laid = lay_out(
        placement.attachment_positions,
        placement.attachment_directions,
        starts,
        planes,
        reading=curves,
        closest=closest,
        square=fidelity == "best",
    )
    hyperedges = np.arange(len(starts))
    return Routing(
        control_points=laid.control_points,
        segment_starts=2 * starts - 3 * hyperedges,
        segment_ends=laid.ends,
        join_positions=laid.joins,
        join_tangents=laid.tangents,
        join_starts=starts - 2 * hyperedges,
        join_planes=planes,
        radii=placement.radii,
    )


def _half_extents(rotations: Floats, sizes: Floats) -> Floats:
    """Half the size, along the world's axes, of boxes turned by quaternions x, y, z, w; (n, 3)."""
    x, y, z, w = rotations.T
    turned = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    return np.asarray(np.einsum("ijn,nj->ni", np.abs(turned), sizes) / 2)
