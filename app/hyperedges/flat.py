"""Hyperedges in one plane: a drawing whose lines may cross, with joins as in space."""

from __future__ import annotations

from typing import Literal

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.curves import join_starts, lay_out, segment_starts
from app.hyperedges.routing import Routing
from app.hyperedges.weaving.fabric import Fabric
from app.hyperedges.weaving.grid import sort_into_cells
from app.hyperedges.weaving.joins import settle_joins
from app.hyperedges.weaving.numbering import number
from app.hyperedges.weaving.plan import Plan, draw_plan
from app.hyperedges.weaving.tangents import choose_tangents
from app.placement.placement import Placement

HANDLE = 0.4
"""Length of a curve's handles, over the distance of its ends."""


def route_flat(
    placement: Placement,
    *,
    curves: Literal["steiner", "prose", "symbolic"] = "steiner",
    fidelity: Literal["best", "paper"] = "best",
) -> Routing:
    """Curves of all hyperedges in the plane that their attachments and directions lie in.

    ``curves`` and ``fidelity`` as for `app.hyperedges.route.route`; nobody looks whether tubes
    keep clear of each other. Raises `ValueError` where a hyperedge has fewer than two attachments.
    """
    starts = placement.attachment_starts
    heights = placement.attachment_positions[starts[:-1], 2].copy()
    if curves == "steiner":
        return _short(placement, heights)
    laid = lay_out(
        placement.attachment_positions,
        placement.attachment_directions,
        starts,
        heights,
        reading=curves,
        fidelity=fidelity,
    )
    # Of equal heights CURVES computes ones that are equal but for rounding.
    laid.control_points[..., 2] = np.repeat(heights, np.diff(segment_starts(starts)))[:, None]
    return Routing(
        control_points=laid.control_points,
        segment_starts=segment_starts(starts),
        segment_ends=laid.ends,
        join_positions=laid.joins,
        join_tangents=laid.tangents,
        join_starts=join_starts(starts),
        join_planes=heights,
        radii=placement.radii,
    )


def _short(placement: Placement, heights: Floats) -> Routing:
    """One curve for each edge of short trees."""
    starts, radii = placement.attachment_starts, placement.radii
    upwards = np.zeros_like(placement.attachment_positions)
    upwards[:, 2] = 1.0
    # What leaves upwards has its feet where it is attached.
    plan = draw_plan(placement.attachment_positions, upwards, starts, radii)
    nobody, nowhere = np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    around = (sort_into_cells(nowhere, 1.0), nowhere, nobody, heights, radii, 0.0)
    settle_joins(plan, *around)
    leaving = choose_tangents(plan, *around)
    owners = np.repeat(np.arange(len(radii)), np.diff(plan.edge_starts))
    nodes = plan.edges + plan.node_starts[owners][:, None]
    ways = leaving.copy()
    is_foot = plan.edges < np.diff(starts)[owners][:, None]
    feet = (plan.edges + starts[:-1][owners][:, None])[is_foot]
    ways[is_foot] = placement.attachment_directions[feet, :2]
    control = _cubics(plan, nodes, ways, heights[owners])
    edges = np.arange(len(owners) + 1)
    return number(plan, Fabric(control, edges, np.ones(len(owners))), leaving, heights, radii)


def _cubics(plan: Plan, nodes: Indices, ways: Floats, heights: Floats) -> Floats:
    """Curves (e, 4, 3) between ``nodes`` (e, 2), which they leave along ``ways`` (e, 2, 2)."""
    ends = plan.places[nodes]
    handles = HANDLE * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None, None] * ways
    control = np.empty((len(nodes), 4, 3))
    control[:, (0, 3), :2] = ends
    control[:, (1, 2), :2] = ends + handles
    control[..., 2] = heights[:, None]
    return control
