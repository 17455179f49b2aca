"""Curves of hyperedges that keep clear of each other, by construction where nothing else helps.

Each hyperedge has a plane of its own, as low as can be: hyperedges share planes unless their plans,
seen from above, come too near to each other. All curves begin as soft arches. Where two come too
near, both are made stricter, until they rise straight from their attachments, run in their planes
only, and go around the risers of those above them; then they cannot meet. What still fails, because
its surroundings are too crowded, is moved above them, where it has nothing to go around.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.hyperedges.stopping import StoppedError
from app.hyperedges.weaving.crossings import find_crossings
from app.hyperedges.weaving.fabric import Fabric
from app.hyperedges.weaving.grid import Grid, sort_into_cells
from app.hyperedges.weaving.hardening import harden, troubled_threads
from app.hyperedges.weaving.joins import settle_joins
from app.hyperedges.weaving.legs import around_legs, control_legs, direct_legs
from app.hyperedges.weaving.lifting import lift
from app.hyperedges.weaving.loom import Loom
from app.hyperedges.weaving.loose import lay_loosely
from app.hyperedges.weaving.plan import Plan, draw_plan
from app.hyperedges.weaving.storeys import first_fit, highest_under, stack
from app.hyperedges.weaving.tangents import choose_tangents, inner_ends
from app.hyperedges.weaving.threads import Still, Surroundings, Threads
from app.hyperedges.weaving.towers import pass_above
from app.hyperedges.weaving.ways import find_ways

ATTEMPTS = 6
"""How often what fails is moved above the rest, at most."""

CELL = 12.0
"""Size of the cells in which feet are sorted, over the mean radius."""

Progress = Callable[[float], None]
"""Told which share of the work is done at least, from 0 to 1.

It may raise to end it; where it raises `StoppedError`, the best so far is what comes of it.
"""


@dataclass(frozen=True, slots=True, eq=False)
class Weave:
    """Curves of all threads, and what is still wrong with them.

    ``leaving`` (e, 2, 2): the directions in which edges leave joins. ``hit`` (g,): which of the
    hyperedges that stand still are too near. ``faults`` counts what is too near, ``pinches`` edges
    that bend too much.
    Where the work was stopped before anything was looked at, it is not ``tried``: all counts are 0.
    """

    plan: Plan
    fabric: Fabric
    leaving: Floats
    planes: Floats
    hit: NDArray[np.bool_]
    faults: int
    pinches: int
    tried: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class _Feet:
    """All feet, those of threads before those that stand still, and the hyperedges they are of."""

    places: Floats
    owners: Indices
    grid: Grid


def weave(
    threads: Threads,
    still: Still,
    surroundings: Surroundings,
    clearance: float,
    progress: Progress = lambda _share: None,
) -> Weave:
    """Curves for ``threads`` that keep clear of each other, of what stands ``still``, and of items.

    Hyperedges in ``surroundings.attached`` are numbered threads first. Where the work is stopped
    before there are any, each hyperedge gets curves that care about nothing else.
    """
    best: list[Weave] = []
    try:
        _weave(threads, still, surroundings, clearance, progress, best)
    except StoppedError:
        if not best:
            return _untried(threads, still)
    return best[-1]


def _untried(threads: Threads, still: Still) -> Weave:
    """Each hyperedge in a plane of its own, whatever else there is."""
    plan, fabric, leaving = lay_loosely(threads)
    hit = np.zeros(len(still.planes), dtype=np.bool_)
    return Weave(plan, fabric, leaving, threads.lows, hit, 0, 0, tried=False)


def _weave(
    threads: Threads,
    still: Still,
    surroundings: Surroundings,
    clearance: float,
    progress: Progress,
    best: list[Weave],
) -> None:
    """Add what is better than all before to ``best``, until nothing more is tried."""
    check = partial(progress, 0.0)
    check()
    drawn = draw_plan(threads.positions, threads.directions, threads.starts, threads.radii)
    woven = len(threads.radii)
    edges = np.repeat(np.arange(woven), np.diff(drawn.edge_starts))
    radii = np.concatenate([threads.radii, still.radii])
    feet = _all_feet(drawn, threads, still, float(radii.mean()) if len(radii) else 1.0)
    still_legs, still_owners = control_legs(still.segments), np.repeat(still.owners + woven, 3)
    direct = direct_legs(drawn)
    lows = np.where(
        threads.given,
        threads.lows,
        pass_above(direct, edges, threads.radii, clearance, surroundings.obstacles, threads.lows),
    )
    lows = np.concatenate([lows, still.planes])
    fixed = np.concatenate([threads.given, np.ones(len(still.planes), dtype=np.bool_)])
    crossings = find_crossings(direct, edges, still_legs, still_owners, radii, clearance, check)
    tops = highest_under(
        still_legs, still_owners, feet.places, feet.owners, lows, radii, clearance, woven
    )
    order = _short_first(drawn, feet.places)
    planes = first_fit(crossings, order[~fixed[order]], lows, tops, radii, clearance)
    loom = _thread(drawn, edges, feet, threads, still, surroundings, planes, radii, clearance)
    lifted = lift(loom, planes, fixed, check)
    lows, planes = np.where(lifted > planes, lifted, lows), lifted
    made, troubled = _try(loom, feet, planes, lows, fixed, check)
    best.append(made)
    for attempt in range(1, ATTEMPTS):
        troubled = troubled[~fixed[troubled]]
        if len(troubled) == 0:
            break
        check = partial(progress, attempt / ATTEMPTS)
        check()
        planes = planes.copy()
        planes[troubled] = planes.max(initial=0.0) + 1.0 + np.arange(len(troubled))
        loom = _thread(drawn, edges, feet, threads, still, surroundings, planes, radii, clearance)
        made, troubled = _try(loom, feet, planes, lows, fixed, check)
        if (made.faults, made.pinches) < (best[-1].faults, best[-1].pinches):
            best.append(made)


def _all_feet(plan: Plan, threads: Threads, still: Still, radius: float) -> _Feet:
    counts = np.diff(threads.starts)
    rows = np.repeat(plan.node_starts[:-1] - threads.starts[:-1], counts)
    own = plan.places[np.arange(len(threads.positions)) + rows]
    places = np.concatenate([own, still.feet])
    owners = np.concatenate(
        [np.repeat(np.arange(len(counts)), counts), still.feet_owners + len(counts)]
    )
    return _Feet(places, owners, sort_into_cells(places, CELL * radius))


def _short_first(plan: Plan, feet: Floats) -> Indices:
    """Hyperedges in the order of their spans, so that long ones pass above short ones."""
    if len(plan.starts) == 1:
        return np.zeros(0, dtype=np.int64)
    own = feet[: plan.starts[-1]]
    lows = np.minimum.reduceat(own, plan.starts[:-1], axis=0)
    highs = np.maximum.reduceat(own, plan.starts[:-1], axis=0)
    return np.argsort((highs - lows).max(axis=1), kind="stable")


def _thread(
    drawn: Plan,
    edges: Indices,
    feet: _Feet,
    threads: Threads,
    still: Still,
    surroundings: Surroundings,
    planes: Floats,
    radii: Floats,
    clearance: float,
) -> Loom:
    """Joins and tangents for the order of ``planes``."""
    plan = drawn._replace(places=drawn.places.copy())
    around = (feet.grid, feet.places, feet.owners, planes, radii)
    settle_joins(plan, *around, clearance)
    leaving = choose_tangents(plan, *around, clearance)
    ends = inner_ends(plan, leaving, edges, radii)
    return Loom(plan, leaving, ends, edges, threads, still, surroundings, radii, clearance)


def _try(
    loom: Loom,
    feet: _Feet,
    planes: Floats,
    lows: Floats,
    fixed: NDArray[np.bool_],
    check: Callable[[], None],
) -> tuple[Weave, Indices]:
    """Curves for the order of ``planes``, and the threads that want a higher one."""
    plan, leaving, ends, edges = loom.plan, loom.leaving, loom.ends, loom.owners
    still, radii, clearance = loom.still, loom.radii, loom.clearance
    woven = len(loom.threads.radii)
    around = (feet.grid, feet.places, feet.owners, planes, radii)
    ways = find_ways(plan, leaving, ends, *around, clearance, check)
    legs, owners = around_legs(plan, ends, edges, ways)
    legs, owners = np.concatenate([direct_legs(plan), legs]), np.concatenate([edges, owners])
    above = pass_above(legs, owners, radii, clearance, loom.surroundings.obstacles, lows)
    lows = np.where(fixed, lows, above)
    crossings = find_crossings(
        legs,
        owners,
        control_legs(still.segments),
        np.repeat(still.owners + woven, 3),
        radii,
        clearance,
        check,
    )
    order = np.argsort(planes, kind="stable")
    planes = stack(crossings, order, lows, fixed, radii, clearance)

    fabric, found = harden(loom, ways, planes, check)
    hit = np.zeros(len(still.planes), dtype=np.bool_)
    standing = found.hyperedges[found.hyperedges >= woven]
    hit[standing - woven] = True
    made = Weave(
        plan,
        fabric,
        leaving,
        planes[:woven],
        hit,
        found.faults.count,
        int(found.pinched.sum()),
    )
    return made, troubled_threads(found, found.pinched | ways.blocked, edges, planes, woven)
