"""Cubics along a skeleton: straight where it is straight, else one for each corner."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.orthogonal.skeleton import Skeleton
from app.hyperedges.weaving.curvature import least_radius

HANDLES = (0.4, 0.45, 0.5, 0.55, 0.35, 0.6)
"""Lengths of a corner's handles to choose from, over the distance of its ends."""

ENOUGH = 2.0
"""Least radius of curvature, over the tube's, with which a corner is good."""

STRAIGHT = 1e-9

LONGEST = 2.0
"""Of the handles of straight ways, document units: long ways are slow near their ends, where an
item is that they may touch."""


def straightened(skeleton: Skeleton) -> Skeleton:
    """The skeleton without the vertices at which nothing turns or branches."""
    before: dict[int, int] = {}
    after: dict[int, list[int]] = defaultdict(list)
    for start, end in skeleton.edges:
        before[end] = start
        after[start].append(end)
    found = Skeleton()
    numbers: dict[int, int] = {}
    for vertex in range(len(skeleton.points)):
        if vertex in before and len(after[vertex]) == 1:
            ends = (before[vertex], vertex, after[vertex][0])
            here = np.array([skeleton.points[each] for each in ends])
            one, other = here[1] - here[0], here[2] - here[1]
            if one @ other > (1.0 - STRAIGHT) * np.linalg.norm(one) * np.linalg.norm(other):
                before[after[vertex][0]] = before[vertex]
                after[before[vertex]] = [
                    after[vertex][0] if each == vertex else each for each in after[before[vertex]]
                ]
                continue
        numbers[vertex] = found.vertex(
            skeleton.points[vertex], skeleton.tangents[vertex], skeleton.ports[vertex]
        )
    found.edges.extend(
        (numbers[start], numbers[end])
        for start, ends in sorted(after.items())
        if start in numbers
        for end in ends
    )
    return found


@njit(cache=True)
def cubics(
    starts: Floats, ends: Floats, headings: Floats, arrivals: Floats, radius: float
) -> Floats:
    """Control points (s, 4, 3) from ``starts`` to ``ends`` (s, 3) with unit tangents (s, 3)."""
    found = np.empty((len(starts), 4, 3))
    trial = np.empty((4, 3))
    for s in range(len(starts)):
        way = ends[s] - starts[s]
        length = np.sqrt(np.sum(way * way))
        found[s, 0], found[s, 3] = starts[s], ends[s]
        if np.sum(way * headings[s]) >= (1.0 - STRAIGHT) * length:
            handle = min(1.0 / 3.0, LONGEST / length)
            found[s, 1] = starts[s] + way * handle
            found[s, 2] = ends[s] - way * handle
            continue
        best = -1.0
        for handle in HANDLES:
            trial[0], trial[3] = starts[s], ends[s]
            trial[1] = starts[s] + handle * length * headings[s]
            trial[2] = ends[s] - handle * length * arrivals[s]
            radius_here = least_radius(trial)
            if radius_here > best:
                best = radius_here
                found[s] = trial
            if best > ENOUGH * radius:
                break
    return found


def numbered(skeleton: Skeleton, first: int, attachments: int) -> tuple[Indices, Indices]:
    """Numbers (v,) of vertices as `Routing` has them, and the inner vertices in that order.

    The net's ports are numbered from ``first`` on.
    """
    degrees = np.bincount(np.array(skeleton.edges).ravel(), minlength=len(skeleton.points))
    ports = np.array(skeleton.ports)
    inner = np.flatnonzero(ports < 0)
    inner = inner[np.argsort(degrees[inner] != 3, kind="stable")]
    numbers = ports - first
    numbers[inner] = attachments + np.arange(len(inner))
    return numbers, inner
