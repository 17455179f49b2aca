"""Ways of all edges of a plan, around the feet of hyperedges above them (Numba)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.grouped import starts_of
from app.hyperedges.clearance.parallel import CORES, in_parts
from app.hyperedges.stopping import unchecked
from app.hyperedges.weaving.detours import find_way
from app.hyperedges.weaving.grid import Grid, collect
from app.hyperedges.weaving.plan import BEND, NEXT, Plan

MOST_NEAR = 4096
"""Feet looked at for one edge."""

MOST_CORNERS = 48

BESIDE = 12.0
"""How far beside its edge a way knows what is there, in radii: detours are short."""

FEW = 100
"""Hyperedges for which a thread is worth while."""

AT_ONCE = FEW * CORES
"""Hyperedges between two looks whether to go on."""

WIDTH = 1.05
"""Ways go around feet at so many times the distance that is needed."""

OWN = 2.2
"""Distance in radii that edges keep from other feet of their own hyperedge."""


class Ways(NamedTuple):
    """Corners of e edges between their ends: ``corners[starts[i] : starts[i + 1]]``, (n, 2).

    ``blocked`` (e,) says for which edges there is none; theirs are straight.
    """

    starts: Indices
    corners: Floats
    blocked: NDArray[np.bool_]


def find_ways(
    plan: Plan,
    leaving: Floats,
    ends: Floats,
    grid: Grid,
    feet: Floats,
    feet_owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
    check: Callable[[], None] = unchecked,
) -> Ways:
    """Ways between ``ends`` (e, 2, 2), around feet of hyperedges whose ``planes`` are higher.

    ``leaving`` (e, 2, 2) are the directions in which they have left joins. ``feet`` (a, 2) are of
    the hyperedges ``feet_owners`` (a,); ``planes`` and ``radii`` (h,).
    ``check`` is called now and then, and may raise to end it.
    """

    def find(begin: int, end: int) -> Ways:
        return _find(
            begin, end, plan, leaving, ends, grid, feet, feet_owners, planes, radii, clearance
        )

    parts: list[Ways] = []
    count = len(plan.starts) - 1
    for first in range(0, max(count, 1), AT_ONCE):
        check()
        some = min(AT_ONCE, count - first)
        parts += in_parts(some, partial(_from, find, first), few=FEW)
    counts = np.concatenate([np.diff(part.starts) for part in parts])
    return Ways(
        starts_of(counts),
        np.concatenate([part.corners for part in parts]),
        np.concatenate([part.blocked for part in parts]),
    )


def _from(find: Callable[[int, int], Ways], first: int, begin: int, end: int) -> Ways:
    return find(first + begin, first + end)


@njit(cache=True, nogil=True)
def _find(
    begin: int,
    end: int,
    plan: Plan,
    leaving: Floats,
    ends: Floats,
    grid: Grid,
    feet: Floats,
    feet_owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
) -> Ways:
    """The same for the hyperedges from ``begin`` to ``end``."""
    before = plan.edge_starts[begin]
    edges = plan.edge_starts[end] - before
    starts = np.zeros(edges + 1, np.int64)
    corners = np.empty((edges + 16, 2))
    blocked = np.zeros(edges, np.bool_)
    found = np.empty(MOST_NEAR, np.int64)
    discs = np.empty((MOST_NEAR + 4, 3))
    way = np.empty((MOST_CORNERS + 2, 2))
    headings = np.empty((2, 2))
    widest = 0.0
    for r in radii:
        widest = max(widest, r)
    count = 0
    for k in range(begin, end):
        reach = WIDTH * max(radii[k] + widest + clearance, BEND * widest)
        for e in range(plan.edge_starts[k], plan.edge_starts[k + 1]):
            ax, ay = ends[e, 0, 0], ends[e, 0, 1]
            bx, by = ends[e, 1, 0], ends[e, 1, 1]
            length = np.hypot(bx - ax, by - ay)
            beside = min(BESIDE * radii[k], 0.3 * length)
            near = collect(grid, ax, ay, bx, by, reach + beside, found)
            m = 0
            for i in range(near):
                size = _size(plan, k, e, found[i], feet_owners, planes, radii, clearance)
                if size > 0.0:
                    x, y = feet[found[i], 0], feet[found[i], 1]
                    # An end within a disc could never leave it.
                    room = min(np.hypot(x - ax, y - ay), np.hypot(x - bx, y - by))
                    discs[m, 0], discs[m, 1], discs[m, 2] = x, y, min(size, 0.98 * room)
                    m += 1
            bend = BEND * radii[k]
            m = _add_turns(ends[e], leaving[e], NEXT * radii[k], bend, discs, m)
            headings[0], headings[1] = leaving[e, 0], -leaving[e, 1]
            turns = find_way(ax, ay, bx, by, discs[:m], headings, bend, way)
            if turns < 0:
                blocked[e - before] = True
                turns = 0
            if count + turns > len(corners):
                more = np.empty((2 * (count + turns), 2))
                more[:count] = corners[:count]
                corners = more
            for i in range(turns):
                corners[count + i] = way[i + 1]
            count += turns
            starts[e + 1 - before] = count
    return Ways(starts, corners[:count], blocked)


@njit(cache=True)
def _size(
    plan: Plan,
    k: int,
    e: int,
    foot: int,
    owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
) -> float:
    """Radius of the disc around a foot that edge ``e`` of hyperedge k avoids, zero for none."""
    other = owners[foot]
    if other == k:
        local = foot - plan.starts[k]
        return 0.0 if local in (plan.edges[e, 0], plan.edges[e, 1]) else OWN * radii[k]
    if planes[other] <= planes[k]:
        return 0.0
    needed = max(radii[k] + radii[other] + clearance, BEND * radii[other])
    return float(WIDTH * max(needed, BEND * 1.05 * radii[k]))


@njit(cache=True)
def _add_turns(
    ends: Floats, leaving: Floats, step: float, bend: float, discs: Floats, count: int
) -> int:
    """Add the circles beside joins on which a way may turn at most; how many discs there are."""
    for side in range(2):
        x, y = leaving[side, 0], leaving[side, 1]
        if x == 0.0 and y == 0.0:
            continue
        for sense in (bend, -bend):
            discs[count, 0] = ends[side, 0] - step * x - 1.02 * sense * y
            discs[count, 1] = ends[side, 1] - step * y + 1.02 * sense * x
            discs[count, 2] = bend
            count += 1
    return count
