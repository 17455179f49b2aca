"""The courses of all edges of a plan, as one array of segments (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.weaving.courses import AROUND, ROOM, End, lay_course
from app.hyperedges.weaving.plan import Plan
from app.hyperedges.weaving.ways import Ways


class Fabric(NamedTuple):
    """Segments of e edges: ``segments[starts[i] : starts[i + 1]]``, (s, 4, 3), are edge i's.

    ``least`` (e,): the least radius of curvature of each edge, over its tube's radius.
    """

    segments: Floats
    starts: Indices
    least: Floats


@njit(cache=True)
def lay_courses(
    plan: Plan,
    ways: Ways,
    strictness: Indices,
    leaving: Floats,
    ends: Floats,
    positions: Floats,
    directions: Floats,
    planes: Floats,
    radii: Floats,
) -> Fabric:
    """Courses of all edges, each as strict as ``strictness`` (e,) says.

    ``leaving`` (e, 2, 2) are the directions in which edges leave joins, ``ends`` (e, 2, 2) the
    places next to them; ``positions`` and ``directions`` (a, 3) are the attachments'; ``planes``
    and ``radii`` (h,).
    """
    edges = len(plan.edges)
    starts = np.zeros(edges + 1, np.int64)
    least = np.empty(edges)
    segments = np.empty((4 * edges + ROOM, 4, 3))
    cubics = np.empty((ROOM, 4, 3))
    way = np.empty((ROOM, 2))
    count = 0
    for k in range(len(plan.starts) - 1):
        for e in range(plan.edge_starts[k], plan.edge_starts[k + 1]):
            start = _end(plan, k, e, 0, leaving, positions, directions, planes[k])
            end = _end(plan, k, e, 1, leaving, positions, directions, planes[k])
            places = _trace(ways, ends[e], start, end, e, strictness[e] >= AROUND, way)
            laid, least[e] = lay_course(
                start, end, way[:places], planes[k], radii[k], strictness[e], cubics
            )
            if count + laid > len(segments):
                more = np.empty((2 * (count + laid), 4, 3))
                more[:count] = segments[:count]
                segments = more
            segments[count : count + laid] = cubics[:laid]
            count += laid
            starts[e + 1] = count
    return Fabric(segments[:count], starts, least)


@njit(cache=True)
def _trace(
    ways: Ways, ends: Floats, start: End, end: End, e: int, around: bool, way: Floats
) -> int:
    """Write the corners of edge ``e`` from node to node; how many there are."""
    count = 0
    if not start.is_attachment:
        way[count] = start.foot
        count += 1
    way[count] = ends[0]
    count += 1
    if around:
        for i in range(ways.starts[e], ways.starts[e + 1]):
            way[count] = ways.corners[i]
            count += 1
    way[count] = ends[1]
    count += 1
    if not end.is_attachment:
        way[count] = end.foot
        count += 1
    return count


@njit(cache=True)
def _end(
    plan: Plan,
    k: int,
    e: int,
    side: int,
    leaving: Floats,
    positions: Floats,
    directions: Floats,
    plane: float,
) -> End:
    node = plan.edges[e, side]
    foot = plan.places[plan.node_starts[k] + node]
    if node < plan.starts[k + 1] - plan.starts[k]:
        number = plan.starts[k] + node
        return End(True, positions[number], directions[number], foot, plan.lifts[number])
    place = np.array([foot[0], foot[1], plane])
    direction = np.array([leaving[e, side, 0], leaving[e, side, 1], 0.0])
    return End(False, place, direction, foot, plane)
