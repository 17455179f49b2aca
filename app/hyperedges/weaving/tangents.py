"""The common tangent of each join: the one that bends its three arms least (Numba)."""

from __future__ import annotations

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.hyperedges.weaving.grid import Grid, collect
from app.hyperedges.weaving.plan import BEND, NEXT, Plan

STEPS = 6
"""Tangents are tried up to so many steps to either side of the best."""

STEP = np.pi / 12.0

NEARNESS = 30.0
"""What it costs that an arm comes one radius too near to a foreign foot, in squared radians."""

COMFORT = 1.2
"""Distance from what tubes need, in radii, from which on nearness costs nothing."""

UNEASE = 1.0
"""What it costs that an arm lacks one radius of that."""

MOST_NEAR = 64


@njit(cache=True)
def choose_tangents(
    plan: Plan,
    grid: Grid,
    feet: Floats,
    owners: Indices,
    planes: Floats,
    radii: Floats,
    clearance: float,
) -> Floats:
    """Unit directions (e, 2, 2) in which each edge leaves its ends; zero at feet.

    At a join one arm, the stem, leaves along the join's tangent and the two others against it:
    that is smooth whichever way one comes. Stem and tangent are those with which the squared angles
    between arms and tangent are least together, among those that keep the arms away from ``feet``
    (a, 2) of hyperedges ``owners`` (a,) whose ``planes`` (h,) are above.
    """
    leaving = np.zeros((len(plan.edges), 2, 2))
    widest = 0.0
    for r in radii:
        widest = max(widest, r)
    headings = np.empty((3, 2))
    found = np.empty(MOST_NEAR, np.int64)
    discs = np.empty((MOST_NEAR, 3))
    for k in range(len(plan.starts) - 1):
        number = plan.starts[k + 1] - plan.starts[k]
        reach = (NEXT + COMFORT) * radii[k] + 1.05 * max(
            radii[k] + widest + clearance, BEND * widest
        )
        for node in range(plan.node_starts[k] + number, plan.node_starts[k + 1]):
            place = plan.places[node]
            near = collect(grid, place[0], place[1], place[0], place[1], reach, found)
            m = 0
            for i in range(near):
                other = owners[found[i]]
                if other != k and planes[other] > planes[k]:
                    discs[m, 0], discs[m, 1] = feet[found[i], 0], feet[found[i], 1]
                    size = max(radii[k] + radii[other] + clearance, BEND * radii[other])
                    discs[m, 2] = 1.05 * max(size, BEND * 1.05 * radii[k])
                    m += 1
            for arm in range(3):
                e = plan.links[node, arm]
                headings[arm] = _heading(plan, k, e, _side(plan, k, e, node))
            stem, x, y = _choose(headings, place, NEXT * radii[k], radii[k], discs[:m])
            for arm in range(3):
                sense = 1.0 if arm == stem else -1.0
                e = plan.links[node, arm]
                side = _side(plan, k, e, node)
                leaving[e, side, 0], leaving[e, side, 1] = sense * x, sense * y
    return leaving


@njit(cache=True)
def _side(plan: Plan, k: int, e: int, node: int) -> int:
    return 0 if plan.edges[e, 0] == node - plan.node_starts[k] else 1


@njit(cache=True)
def _heading(plan: Plan, k: int, e: int, side: int) -> Floats:
    """In which direction (2,) edge ``e`` of hyperedge k leaves its end ``side`` (0 or 1)."""
    first = plan.node_starts[k]
    here = plan.places[first + plan.edges[e, side]]
    there = plan.places[first + plan.edges[e, 1 - side]]
    x, y = there[0] - here[0], there[1] - here[1]
    length = np.hypot(x, y)
    if length == 0.0:
        return np.array([1.0, 0.0])
    return np.array([x / length, y / length])


@njit(cache=True)
def _choose(
    headings: Floats, place: Floats, step: float, radius: float, discs: Floats
) -> tuple[int, float, float]:
    best, stem, best_x, best_y = np.inf, 0, 1.0, 0.0
    for arm in range(3):
        along_x = 3.0 * headings[arm, 0] - headings[:, 0].sum()
        along_y = 3.0 * headings[arm, 1] - headings[:, 1].sum()
        length = np.hypot(along_x, along_y)
        if length < 1e-9:
            along_x, along_y, length = headings[arm, 0], headings[arm, 1], 1.0
        for turn in range(-STEPS, STEPS + 1):
            cosine, sine = np.cos(turn * STEP) / length, np.sin(turn * STEP) / length
            x, y = along_x * cosine - along_y * sine, along_x * sine + along_y * cosine
            cost = 0.0
            for other in range(3):
                inner = headings[other, 0] * x + headings[other, 1] * y
                inner = inner if other == arm else -inner
                cost += np.arccos(min(max(inner, -1.0), 1.0)) ** 2
            if len(discs) > 0:
                for sense in (step, -step):
                    at_x, at_y = place[0] + sense * x, place[1] + sense * y
                    for i in range(len(discs)):
                        gap = np.hypot(at_x - discs[i, 0], at_y - discs[i, 1]) - discs[i, 2]
                        if gap < 0.0:
                            cost += NEARNESS * (gap / radius) ** 2
                        gap -= COMFORT * radius
                        if gap < 0.0:
                            cost += UNEASE * (gap / radius) ** 2
            if cost < best - 1e-12:
                best, stem, best_x, best_y = cost, arm, x, y
    return stem, best_x, best_y


def inner_ends(plan: Plan, leaving: Floats, owners: Indices, radii: Floats) -> Floats:
    """Between which places (e, 2, 2) the edges are free to run: feet, or `NEXT` to joins.

    ``owners`` (e,) are the edges' hyperedges, with tubes of ``radii`` (h,).
    """
    ends = plan.places[plan.node_starts[owners][:, None] + plan.edges]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    steps = np.minimum(NEXT * radii[owners], 0.3 * lengths)
    return np.asarray(ends + steps[:, None, None] * leaving)
