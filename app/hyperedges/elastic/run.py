"""Runs of relaxation steps, with lists of neighbours that are renewed when they are out of date."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.near_items import ItemsAround
from app.hyperedges.elastic.beads import Beads, Fixed, lay_beads, lines_of
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.faults import Curves
from app.hyperedges.elastic.neighbours import Items, find_near
from app.hyperedges.elastic.polylines import Polylines
from app.hyperedges.elastic.relaxation import Rates, relax

SKINS = (1.2, 2.4)
"""How far apart neighbours may be, beyond what they need, over their radii.

Little where lists of neighbours last for more than `LONG` steps, more where for less than `BRIEF`.
"""

BRIEF, LONG = 5, 16

TIGHTEST = 2.0
"""Radius of curvature, over the tube's, below which chains are opened."""

AT_ONCE = 4_000_000
"""Segments times steps between two reports of progress."""

ROOMY, SHORT = 8, 2.0
"""Segments of a chain between joins that has room to turn; how much more angles cost with none."""

Progress = Callable[[], None]
"""Told that work goes on. May raise to end it."""


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What chains are kept clear of, and how far.

    ``items`` are there to push with, ``proven`` to prove that curves are clear of them. ``fixed``
    and ``kept`` are the same curves, as polylines and as cubics.
    """

    items: Items
    proven: ItemsAround
    fixed: Fixed
    kept: Curves
    clearance: float


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Beads at their places ``x`` (b, 3).

    ``stems`` (j,) say which link of a join is its stem. ``slack`` (s,): how many times its share of
    `run`'s slack each segment keeps from others. ``curvatures`` (h,)
    are those that arches are drawn to. ``stretch`` (c,): how many times farther than usual the ends
    of a chain at a join are kept apart. ``bends`` (b,): the least radius of curvature at a bead.
    """

    chains: Chains
    beads: Beads
    x: Floats
    stems: Indices
    slack: Floats
    curvatures: Floats
    stretch: Floats
    bends: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Beads that are ``moving`` (b,), and the segments ``among`` (k,) which they do so."""

    moving: Flags
    among: Indices


def state_of(chains: Chains, lines: Polylines, fixed: Fixed, curvatures: Floats) -> State:
    """Beads along polylines."""
    beads, x = lay_beads(chains, lines, fixed, curvatures)
    return State(
        chains,
        beads,
        x,
        choose_stems(x, beads, chains),
        np.ones(len(beads.segments)),
        curvatures,
        np.ones(len(chains.ends)),
        TIGHTEST * beads.thickness,
    )


def spaced_anew(state: State, fixed: Fixed) -> State:
    """The same chains with their beads evenly spaced again, and their stems chosen anew."""
    return state_of(state.chains, lines_of(state.beads, state.x), fixed, state.curvatures)


def higher(state: State, curvatures: Floats) -> State:
    """The same beads, drawn to arches of other ``curvatures`` (h,)."""
    old = np.where(state.curvatures > 0.0, state.curvatures, 1.0)
    ratios = np.append(np.where(state.curvatures > 0.0, curvatures / old, 1.0), 1.0)
    owners = np.full(len(state.x), len(curvatures))
    count = int(state.beads.segment_starts[-1])
    owners[state.beads.segments[:count]] = state.beads.owners[:count, None]
    lifted = state.beads._replace(lifts=state.beads.lifts * ratios[owners, None])
    return replace(state, beads=lifted, curvatures=curvatures)


def choose_stems(x: Floats, beads: Beads, chains: Chains) -> Indices:
    """The arm of each join that its two others go on into best, as a link: (j,).

    That for which the squares of the angles between arms and the join's tangent come to least.
    Those of arms that lead to another join nearby count more: there is little room to turn.
    """
    joins = chains.joins
    arms = x[beads.links[:joins]] - x[:joins, None]
    arms /= np.maximum(np.linalg.norm(arms, axis=2), 1e-12)[:, :, None]
    lack = np.maximum(0.0, 1.0 - np.diff(beads.segment_starts) / ROOMY)
    lack *= (chains.ends < joins).all(axis=1)
    of = np.searchsorted(beads.starts, beads.links[:joins], side="right") - 1
    costs = np.empty((joins, 3))
    for stem in range(3):
        signs = np.where(np.arange(3) == stem, 1.0, -1.0)
        tangents = (arms * np.where(signs > 0, 1.0, -0.5)[:, None]).sum(axis=1)
        tangents /= np.maximum(np.linalg.norm(tangents, axis=1), 1e-12)[:, None]
        along = np.clip(signs * np.einsum("jkc,jc->jk", arms, tangents), -1.0, 1.0)
        costs[:, stem] = (np.arccos(along) ** 2 * (1.0 + SHORT * lack[of])).sum(axis=1)
    return np.asarray(costs.argmin(axis=1))


def run(
    state: State,
    around: Surroundings,
    rates: Rates,
    steps: int,
    slack: float,
    progress: Progress,
    part: Part | None = None,
) -> None:
    """Take so many steps, in place; of a ``part`` of the beads alone, if that is given."""
    beads, chains, x = state.beads, state.chains, state.x
    may = beads.free > 0.0
    if part is not None:
        may &= part.moving
    if not may.any():
        return
    rooms = (beads.radii + 0.5 * around.clearance) * (1.0 + (slack - 1.0) * state.slack)
    skin = SKINS[1]
    movers = np.flatnonzero(may)
    beside = may.copy()
    linked = beads.links[movers]
    beside[linked[linked >= 0]] = True
    near_movers = np.flatnonzero(beside)
    at_once = max(AT_ONCE // (len(movers) + 1), 1)
    step = 0
    while step < steps:
        progress()
        size = max(rates.begin, rates.end)
        near = find_near(
            x,
            beads,
            chains,
            around.items,
            rooms,
            state.stretch,
            around.clearance,
            may,
            size,
            skin,
            None if part is None else part.among,
            progress,
        )
        begun, step = (
            step,
            relax(
                x,
                beads.links,
                beads.degrees,
                state.stems,
                beads.free * may,
                beads.thickness,
                state.bends,
                beads.spans,
                beads.lows,
                beads.highs,
                beads.lifts,
                beads.segments,
                rooms,
                0.5 * around.clearance,
                movers,
                near_movers,
                near,
                around.items.boxes,
                rates,
                step,
                min(step + at_once, steps),
                skin,
            ),
        )
        if step - begun > LONG:
            skin = max(skin / 1.4, SKINS[0])
        elif step - begun < BRIEF:
            skin = min(skin * 1.4, SKINS[1])
