"""From the courses of edges to numbered segments, joins and bends."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import rows_from, starts_of
from app.hyperedges.routing import Routing
from app.hyperedges.weaving.fabric import Fabric
from app.hyperedges.weaving.plan import Plan


def number(plan: Plan, fabric: Fabric, leaving: Floats, planes: Floats, radii: Floats) -> Routing:
    """The routing of a fabric: segments edge by edge, joins of three segments before bends.

    ``leaving`` (e, 2, 2) are the directions in which edges leave joins; ``planes`` and ``radii``
    (h,).
    """
    hyperedges = len(radii)
    feet = np.diff(plan.starts)
    counts = np.diff(fabric.starts)
    owners = np.repeat(np.arange(hyperedges), np.diff(plan.edge_starts))
    bends = counts - 1
    bend_starts = starts_of(bends)
    # Bends are numbered within their hyperedge, after its attachments and joins.
    nodes = np.diff(plan.node_starts)
    first_bends = nodes[owners] + bend_starts[:-1] - bend_starts[plan.edge_starts[owners]]
    segment_edges = np.repeat(np.arange(len(counts)), counts)
    places = np.arange(len(segment_edges)) - fabric.starts[segment_edges]
    ends = np.stack([places - 1, places], axis=1) + first_bends[segment_edges][:, None]
    ends[fabric.starts[:-1], 0] = plan.edges[:, 0]
    ends[fabric.starts[1:] - 1, 1] = plan.edges[:, 1]

    joins_of_three = nodes - feet
    bends_of = np.diff(bend_starts[plan.edge_starts])
    join_starts = starts_of(joins_of_three + bends_of)
    positions = np.empty((join_starts[-1], 3))
    tangents = np.empty((join_starts[-1], 3))
    rows = rows_from(join_starts[:-1], joins_of_three)
    positions[rows], tangents[rows] = _joins(plan, leaving, planes, joins_of_three)
    rows = rows_from(join_starts[:-1] + joins_of_three, bends_of)
    last = np.ones(len(segment_edges), dtype=np.bool_)
    last[fabric.starts[1:] - 1] = False
    before = fabric.segments[last]
    positions[rows] = before[:, 3]
    ahead = before[:, 3] - before[:, 2]
    lengths = np.linalg.norm(ahead, axis=1, keepdims=True)
    # A course of zero length has no direction; any will do.
    upwards = np.tile([0.0, 0.0, 1.0], (len(ahead), 1))
    tangents[rows] = np.divide(ahead, lengths, out=upwards, where=lengths > 0.0)
    return Routing(
        control_points=fabric.segments,
        segment_starts=fabric.starts[plan.edge_starts],
        segment_ends=ends,
        join_positions=positions,
        join_tangents=tangents,
        join_starts=join_starts,
        join_planes=planes,
        radii=radii,
    )


def _joins(plan: Plan, leaving: Floats, planes: Floats, counts: Indices) -> tuple[Floats, Floats]:
    """Positions and tangents (j, 3) of the joins of three segments."""
    rows = rows_from(plan.node_starts[1:] - counts, counts)
    owners = np.repeat(np.arange(len(counts)), counts)
    edges = plan.links[rows, 0]
    is_second = plan.edges[edges, 0] != rows - plan.node_starts[owners]
    flat = leaving[edges, is_second.astype(np.int64)]
    positions = np.concatenate([plan.places[rows], planes[owners][:, None]], axis=1)
    tangents = np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)
    return positions, tangents
