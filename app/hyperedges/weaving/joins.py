"""Room for joins: away from each other, from their feet, and from foreign feet (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.weaving.grid import Grid, collect
from app.hyperedges.weaving.plan import BEND, NEXT, Plan

STEM = 5.0
"""Least length in radii of an edge between a foot and a join: a bend upwards and one sideways."""

SPAN = 7.0
"""The same between two joins: room for two bends."""

ASIDE = 1.06
"""How much farther than tubes need joins keep from foreign feet, besides `NEXT`."""

SWEEPS = 40

RINGS = 16
"""A join that is cramped looks for a better place in so many rings around it."""

RING = 0.75
"""Distance of those rings, in radii."""

CRAMPED = 12.0
"""What a place costs for each unit of distance that is lacking, in units of length."""

MOST_NEAR = 256


@njit(cache=True)
def settle_joins(
    plan: Plan,
    grid: Grid,
    feet: Floats,
    owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
) -> None:
    """Move the joins of ``plan`` to where a tube has room to bend beside them.

    They keep away from ``feet`` (a, 2) of the hyperedges ``owners`` (a,) whose ``planes`` (h,) are
    above their own. ``radii`` (h,).
    """
    widest = 0.0
    for r in radii:
        widest = max(widest, r)
    near = np.empty(MOST_NEAR, np.int64)
    discs = np.empty((MOST_NEAR, 3))
    for k in range(len(plan.starts) - 1):
        first = plan.node_starts[k] + plan.starts[k + 1] - plan.starts[k]
        last = plan.node_starts[k + 1]
        if first == last:
            continue
        for _ in range(SWEEPS):
            worst = _spread(plan, k, radii[k])
            for join in range(first, last):
                place = plan.places[join]
                count = _discs(
                    place, 0.0, k, grid, feet, owners, planes, radii, widest, clearance, near, discs
                )
                for i in range(count):
                    worst = max(worst, _push(place, discs[i]))
            if worst < 1e-2 * radii[k]:
                break
        if worst < 0.1 * radii[k]:
            continue
        for _ in range(2):
            for join in range(first, last):
                reach = RINGS * RING * radii[k]
                count = _discs(
                    plan.places[join],
                    reach,
                    k,
                    grid,
                    feet,
                    owners,
                    planes,
                    radii,
                    widest,
                    clearance,
                    near,
                    discs,
                )
                _look_around(plan, k, join, radii[k], discs[:count])


@njit(cache=True)
def _discs(
    place: Floats,
    reach: float,
    k: int,
    grid: Grid,
    feet: Floats,
    owners: Indices,
    planes: Floats,
    radii: Floats,
    widest: float,
    clearance: float,
    near: Indices,
    discs: Floats,
) -> int:
    """Discs that joins of hyperedge k avoid within ``reach`` of a place; how many there are."""
    most = max(radii[k] + widest + clearance, BEND * max(widest, 1.05 * radii[k]))
    found = collect(
        grid,
        place[0],
        place[1],
        place[0],
        place[1],
        reach + ASIDE * most + NEXT * radii[k],
        near,
    )
    count = 0
    for i in range(found):
        other = owners[near[i]]
        if other != k and planes[other] > planes[k]:
            needed = max(radii[k] + radii[other] + clearance, BEND * radii[other])
            needed = max(needed, BEND * 1.05 * radii[k])
            discs[count, 0], discs[count, 1] = feet[near[i], 0], feet[near[i], 1]
            discs[count, 2] = ASIDE * needed + NEXT * radii[k]
            count += 1
    return count


@njit(cache=True)
def _push(place: Floats, disc: Floats) -> float:
    """Move a place out of a disc; by how much."""
    x, y = place[0] - disc[0], place[1] - disc[1]
    length = np.hypot(x, y)
    if length >= disc[2]:
        return 0.0
    if length == 0.0:
        x, y, length = 1.0, 0.0, 1.0
    place[0], place[1] = disc[0] + disc[2] * x / length, disc[1] + disc[2] * y / length
    return float(disc[2] - length)


@njit(cache=True)
def _look_around(plan: Plan, k: int, join: int, radius: float, discs: Floats) -> None:
    """Move a cramped join to the best place around it."""
    x, y = plan.places[join, 0], plan.places[join, 1]
    if _lacking(plan, k, join, x, y, radius, discs) < 0.1 * radius:
        return
    best, best_x, best_y = np.inf, x, y
    for ring in range(RINGS + 1):
        for step in range(max(1, 6 * ring)):
            angle = np.pi * step / max(1, 3 * ring)
            at_x = x + ring * RING * radius * np.cos(angle)
            at_y = y + ring * RING * radius * np.sin(angle)
            cost = CRAMPED * _lacking(plan, k, join, at_x, at_y, radius, discs)
            if cost >= best:
                continue
            for arm in range(3):
                other = _across(plan, k, join, arm)
                cost += np.hypot(plan.places[other, 0] - at_x, plan.places[other, 1] - at_y)
            if cost < best - 1e-12:
                best, best_x, best_y = cost, at_x, at_y
    plan.places[join, 0], plan.places[join, 1] = best_x, best_y


@njit(cache=True)
def _across(plan: Plan, k: int, node: int, arm: int) -> int:
    """The node at the other end of an edge."""
    e = plan.links[node, arm]
    first = plan.node_starts[k]
    other = plan.edges[e, 1] if plan.edges[e, 0] == node - first else plan.edges[e, 0]
    return int(first + other)


@njit(cache=True)
def _lacking(
    plan: Plan, k: int, join: int, x: float, y: float, radius: float, discs: Floats
) -> float:
    """How much distance a join at a place lacks, all together."""
    feet = plan.node_starts[k] + plan.starts[k + 1] - plan.starts[k]
    total = 0.0
    for arm in range(3):
        other = _across(plan, k, join, arm)
        needed = (STEM if other < feet else SPAN) * radius
        length = np.hypot(plan.places[other, 0] - x, plan.places[other, 1] - y)
        total += max(0.0, needed - length)
    for i in range(len(discs)):
        total += max(0.0, discs[i, 2] - np.hypot(discs[i, 0] - x, discs[i, 1] - y))
    return total


@njit(cache=True)
def _spread(plan: Plan, k: int, radius: float) -> float:
    """Lengthen edges of one tree that are too short for a tube to bend; by how much at most."""
    places, edges = plan.places, plan.edges
    first = plan.node_starts[k]
    feet = plan.starts[k + 1] - plan.starts[k]
    worst = 0.0
    for e in range(plan.edge_starts[k], plan.edge_starts[k + 1]):
        a, b = edges[e, 0], edges[e, 1]
        if a < feet and b < feet:
            continue
        needed = (STEM if min(a, b) < feet else SPAN) * radius
        x = places[first + b, 0] - places[first + a, 0]
        y = places[first + b, 1] - places[first + a, 1]
        length = np.hypot(x, y)
        if length >= needed * (1.0 - 1e-6):
            continue
        worst = max(worst, needed - length)
        if length > 1e-3 * needed:
            x, y = x / length, y / length
        else:
            x, y = _way_out(plan, k, e)
        push = needed - length
        share = 0.5 if min(a, b) >= feet else (0.0 if a < feet else 1.0)
        places[first + a, 0] -= push * share * x
        places[first + a, 1] -= push * share * y
        places[first + b, 0] += push * (1.0 - share) * x
        places[first + b, 1] += push * (1.0 - share) * y
    return worst


@njit(cache=True)
def _way_out(plan: Plan, k: int, e: int) -> tuple[float, float]:
    """Where to pull the second end of edge ``e`` whose ends coincide: between its other arms."""
    first = plan.node_starts[k]
    feet = plan.starts[k + 1] - plan.starts[k]
    sense = 1.0 if plan.edges[e, 1] >= feet else -1.0
    join = first + (plan.edges[e, 1] if sense > 0.0 else plan.edges[e, 0])
    sum_x, sum_y, last_x, last_y = 0.0, 0.0, 1.0, 0.0
    for arm in range(3):
        if plan.links[join, arm] == e:
            continue
        other = _across(plan, k, join, arm)
        x = plan.places[other, 0] - plan.places[join, 0]
        y = plan.places[other, 1] - plan.places[join, 1]
        length = np.hypot(x, y)
        if length > 0.0:
            last_x, last_y = x / length, y / length
            sum_x += last_x
            sum_y += last_y
    length = np.hypot(sum_x, sum_y)
    if length > 0.3:
        return sense * sum_x / length, sense * sum_y / length
    return -sense * last_y, sense * last_x
