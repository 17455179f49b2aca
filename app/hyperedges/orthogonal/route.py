"""From a plan in layers to a routing."""

from __future__ import annotations

import numpy as np

from app.arrays import Floats, Indices
from app.grouped import starts_of
from app.hyperedges.orthogonal.cubics import cubics, numbered, straightened
from app.hyperedges.orthogonal.skeleton import skeletons
from app.hyperedges.routing import Routing
from app.placement.layers.plan import Layers, Plan


def route_in_layers(layers: Layers, starts: Indices, radii: Floats) -> Routing:
    """The curves of all hyperedges of a program in layers.

    Attachments of hyperedge k are ``starts[k]`` to ``starts[k + 1]`` (h + 1,); ``radii`` (h,) are
    the tubes'.
    """
    parts = [
        _route(plan, starts_of(np.diff(starts)[nets]), radii[nets])
        for plan, nets in zip(layers.plans, layers.nets, strict=True)
    ]
    if not parts:
        return Routing.nothing()
    whole = Routing(
        control_points=np.concatenate([part.control_points for part in parts]),
        segment_starts=starts_of(np.concatenate([np.diff(part.segment_starts) for part in parts])),
        segment_ends=np.concatenate([part.segment_ends for part in parts]),
        join_positions=np.concatenate([part.join_positions for part in parts]),
        join_tangents=np.concatenate([part.join_tangents for part in parts]),
        join_starts=starts_of(np.concatenate([np.diff(part.join_starts) for part in parts])),
        join_planes=np.zeros(len(radii)),
        radii=np.concatenate([part.radii for part in parts]),
    )
    return whole.part(np.argsort(np.concatenate(layers.nets)))


def _route(plan: Plan, starts: Indices, radii: Floats) -> Routing:
    """The curves of the nets of one plan."""
    curves: list[Floats] = []
    ends: list[Indices] = []
    places: list[Floats] = []
    tangents: list[Floats] = []
    segments, joins = [], []
    for net, skeleton in enumerate(map(straightened, skeletons(plan))):
        points, headings = np.array(skeleton.points), np.array(skeleton.tangents)
        edges = np.array(skeleton.edges)
        numbers, inner = numbered(skeleton, starts[net], starts[net + 1] - starts[net])
        one, other = edges.T
        curves.append(
            cubics(points[one], points[other], headings[one], headings[other], radii[net])
        )
        ends.append(numbers[edges])
        places.append(points[inner])
        tangents.append(headings[inner])
        segments.append(len(edges))
        joins.append(len(inner))
    return Routing(
        control_points=np.concatenate(curves),
        segment_starts=starts_of(np.array(segments)),
        segment_ends=np.concatenate(ends),
        join_positions=np.concatenate(places),
        join_tangents=np.concatenate(tangents),
        join_starts=starts_of(np.array(joins)),
        join_planes=np.zeros(len(radii)),
        radii=radii,
    )
