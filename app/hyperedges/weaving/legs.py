"""Straight legs of plans, as pairs of places in the plane."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.hyperedges.weaving.plan import Plan
from app.hyperedges.weaving.ways import Ways


def direct_legs(plan: Plan) -> Floats:
    """Legs (e, 2, 2) straight from node to node of each edge."""
    owners = np.repeat(np.arange(len(plan.starts) - 1), np.diff(plan.edge_starts))
    return np.asarray(plan.places[plan.node_starts[owners][:, None] + plan.edges])


def around_legs(plan: Plan, ends: Floats, owners: Indices, ways: Ways) -> tuple[Floats, Indices]:
    """Legs (m, 2, 2) of all ways between ``ends`` (e, 2, 2), and from there to the nodes.

    ``owners`` (e,) are the edges' hyperedges; returns those of the legs (m,) as well.
    """
    counts = np.diff(ways.starts)
    firsts = ways.starts[:-1] + 2 * np.arange(len(counts))
    chain = np.empty((len(ways.corners) + 2 * len(counts), 2))
    chain[firsts] = ends[:, 0]
    chain[firsts + counts + 1] = ends[:, 1]
    corners = np.arange(len(ways.corners)) + np.repeat(2 * np.arange(len(counts)) + 1, counts)
    chain[corners] = ways.corners
    legs = np.stack([chain[:-1], chain[1:]], axis=1)
    within = np.ones(len(legs), dtype=np.bool_)
    within[firsts[1:] - 1] = False
    stubs = np.stack([ends, direct_legs(plan)], axis=2).reshape(-1, 2, 2)
    return (
        np.concatenate([legs[within], stubs]),
        np.concatenate([np.repeat(owners, counts + 1), np.repeat(owners, 2)]),
    )


def control_legs(segments: Floats) -> Floats:
    """Legs (3 s, 2, 2) between the control points of segments (s, 4, 3), seen from above."""
    flat = segments[:, :, :2]
    return np.stack([flat[:, :-1], flat[:, 1:]], axis=2).reshape(-1, 2, 2)
