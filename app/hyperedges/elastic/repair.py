"""Curves that still come too near, or bend too much, are mended where they do."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.box_tree import meeting_any, plant
from app.hyperedges.elastic.assembly import routing_of
from app.hyperedges.elastic.beads import SPACING
from app.hyperedges.elastic.faults import Faults, find_faults
from app.hyperedges.elastic.fitting import Pieces, fit
from app.hyperedges.elastic.relaxation import Rates
from app.hyperedges.elastic.run import (
    ROOMY,
    TIGHTEST,
    Part,
    Progress,
    State,
    Surroundings,
    higher,
    run,
)
from app.hyperedges.elastic.windows import windows
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import StoppedError

ROUNDS = 30
"""How often what is wrong is mended, at most."""

LIFTING = 4
"""Every so many rounds what is wrong hangs higher instead."""

HIGHER = 1.3
MOST_SLACK = 4.0
MOST_STRETCH = 2.5
WIDER, MOST_WIDER = 1.2, 2.5

LARGE = 2000
"""Segments that may move above which only beads near to what is wrong move."""

NEIGHBOURHOOD = 6.0
"""How near that is, in distances of beads."""

BESIDE = 1.6
"""So many times as far are the segments that what moves there may come near to."""

STIFF, STILL = Rates(0.05, 0.2), Rates(0.0, 0.05)
LIFTED = Rates(0.25, 0.2)
SMOOTHINGS = 6


@dataclass(frozen=True, slots=True, eq=False)
class Mended:
    """Curves, and what is still wrong with them: ``faults``, or None where nobody has looked."""

    routing: Routing
    state: State
    pieces: Pieces
    faults: Faults | None


def mend(
    state: State,
    around: Surroundings,
    sweeps: Indices,
    progress: Progress,
    rounds: int = ROUNDS,
) -> Mended:
    """The best curves of so many rounds of mending, or of fewer where ``progress`` stops it."""
    best: list[Mended] = []
    try:
        _mend(state, around, sweeps, progress, rounds, best)
    except StoppedError:
        if not best:
            return unmended(state, sweeps)
    return best[-1]


def unmended(state: State, sweeps: Indices) -> Mended:
    """Curves along the beads as they are."""
    pieces = fit(state.x, state.beads, state.chains, state.stems, sweeps)
    return Mended(routing_of(pieces, state.x, state.chains), state, pieces, None)


def _mend(
    state: State,
    around: Surroundings,
    sweeps: Indices,
    progress: Progress,
    rounds: int,
    best: list[Mended],
) -> None:
    """Add what is better than all before to ``best``, round by round."""
    hyperedges = len(state.chains.radii)
    active = np.ones(hyperedges, dtype=np.bool_)
    fewest = np.inf
    pieces: Pieces | None = None
    for number in range(rounds + 1):
        progress()
        pieces = fit(state.x, state.beads, state.chains, state.stems, sweeps, pieces, active)
        routing = routing_of(pieces, state.x, state.chains)
        faults = find_faults(
            routing, around.kept, around.proven, around.clearance, active, progress
        )
        if faults.count < fewest:
            fewest = faults.count
            best.append(Mended(routing, replace(state, x=state.x.copy()), pieces, faults))
        if faults.count == 0 or number == rounds:
            break
        before = state.x.copy()
        wrong = troubled(faults, routing, hyperedges)
        _loosen(state, pieces, faults)
        near = _near(state, faults, routing)
        if number % LIFTING == LIFTING - 1 and (wrong & state.chains.hung).any():
            state = higher(state, np.where(wrong, HIGHER, 1.0) * state.curvatures)
            run(state, around, LIFTED, 60, 1.2, progress, near)
        else:
            _push(state, pieces, faults, around.clearance)
            _smooth(state, pieces, faults.pinched)
            _stretch(state, pieces, faults.pinched)
            run(state, around, STIFF, 24, 1.2, progress, near)
            run(state, around, STILL, 10, 1.2, progress, near)
            _push(state, pieces, faults, around.clearance)
        active = wrong | _moved(state, before)


def troubled(faults: Faults, routing: Routing, hyperedges: int) -> Flags:
    """Which hyperedges (h,) have faults."""
    owners = np.repeat(np.arange(hyperedges), np.diff(routing.segment_starts))
    found = np.zeros(hyperedges, dtype=np.bool_)
    found[owners[faults.segments]] = True
    others = faults.others[(faults.others >= 0) & (faults.others < len(owners))]
    found[owners[others]] = True
    found[owners[faults.pinched]] = True
    found[faults.own] = True
    return found


def _moved(state: State, before: Floats) -> Flags:
    """Which hyperedges (h,) have beads that moved."""
    beads = state.beads
    count = int(beads.segment_starts[-1])
    moved = (state.x != before).any(axis=1)[beads.segments[:count]].any(axis=1)
    found = np.zeros(len(state.chains.radii), dtype=np.bool_)
    found[beads.owners[:count][moved]] = True
    return found


def _loosen(state: State, pieces: Pieces, faults: Faults) -> None:
    """More slack for segments that come too near."""
    count = len(pieces.chains)
    others = faults.others[(faults.others >= 0) & (faults.others < count)]
    _, lines = windows(pieces, state, np.unique(np.concatenate([faults.segments, others])), 2)
    rows = np.unique(lines[lines >= 0])
    state.slack[rows] = np.minimum(state.slack[rows] + 1.0, MOST_SLACK)
    middles = state.x[state.beads.segments[: state.beads.segment_starts[-1]]].mean(axis=1)
    owners = state.beads.owners[: len(middles)]
    for hyperedge, place in zip(faults.own.tolist(), faults.own_places, strict=True):
        mine = np.flatnonzero(owners == hyperedge)
        far = np.linalg.norm(middles[mine] - place, axis=1)
        mine = mine[far < 2.5 * 4.0 * state.chains.radii[hyperedge]]
        state.slack[mine] = np.minimum(state.slack[mine] + 1.0, MOST_SLACK)


def _push(state: State, pieces: Pieces, faults: Faults, clearance: float) -> None:
    """Move beads of two curves apart where these come too near, and away from items."""
    count = len(pieces.chains)
    for segments, sign in ((faults.segments, 1.0), (faults.others, -1.0)):
        rows = np.flatnonzero((segments >= 0) & (segments < count))
        if len(rows) == 0:
            continue
        beads, _ = windows(pieces, state, segments[rows], 2)
        inside = (beads >= 0) & (state.beads.free[beads] > 0.0)
        far = np.linalg.norm(state.x[beads] - faults.places[rows, None], axis=2)
        radius = state.chains.radii[state.chains.owners[pieces.chains[segments[rows]]]]
        weights = np.where(inside, np.maximum(0.0, 1.0 - far / (10.0 * radius[:, None])), 0.0)
        lack = np.maximum(1.2 * clearance - faults.lower[rows], 0.25 * radius)
        ways = sign * np.minimum(0.6 * lack, 1.2 * radius)[:, None] * faults.ways[rows]
        sums, totals = np.zeros_like(state.x), np.zeros(len(state.x))
        np.add.at(sums, beads, weights[:, :, None] * ways[:, None])
        np.add.at(totals, beads, weights)
        state.x[:] += sums / np.maximum(totals, 1.0)[:, None]
        np.clip(state.x[:, 2], state.beads.lows, state.beads.highs, out=state.x[:, 2])


def _smooth(state: State, pieces: Pieces, pinched: Indices) -> None:
    """Wider bends where curves bend too much; at joins, beads between their neighbours."""
    if len(pinched) == 0:
        return
    along, _ = windows(pieces, state, pinched, 1)
    beads = np.unique(along[along >= 0])
    state.bends[beads] = np.minimum(
        WIDER * state.bends[beads], MOST_WIDER * TIGHTEST * state.beads.thickness[beads]
    )
    chain, spans = pieces.chains[pinched], pieces.spans[pinched]
    at_join = state.chains.ends[chain] < state.chains.joins
    at_join[:, 0] &= spans[:, 0] == 0
    at_join[:, 1] &= spans[:, 1] == np.diff(state.beads.segment_starts)[chain]
    along, _ = windows(pieces, state, pinched[at_join.any(axis=1)], 1)
    beads = np.unique(along[along >= 0])
    beads = beads[state.beads.free[beads] > 0.0]
    links, degrees = state.beads.links[beads], state.beads.degrees[beads]
    for _ in range(SMOOTHINGS):
        there = np.where((links >= 0)[:, :, None], state.x[links], 0.0)
        state.x[beads] += 0.5 * (there.sum(axis=1) / degrees[:, None] - state.x[beads])


def _stretch(state: State, pieces: Pieces, pinched: Indices) -> None:
    """More room between the ends of short chains that bend too much."""
    rows = np.unique(pieces.chains[pinched])
    counts = np.diff(state.beads.segment_starts)[rows]
    rows = rows[counts < ROOMY]
    state.stretch[rows] = np.minimum(1.25 * state.stretch[rows], MOST_STRETCH)


def _near(state: State, faults: Faults, routing: Routing) -> Part | None:
    """What is near to what is wrong, and may move; None for all."""
    beads = state.beads
    if int(beads.segment_starts[-1]) <= LARGE:
        return None
    places = np.concatenate(
        [faults.places, routing.control_points[faults.pinched, 0], faults.own_places]
    )
    reach = NEIGHBOURHOOD * SPACING * float(state.chains.radii.max())
    lines = np.zeros((len(beads.segments), 8))
    one, other = (state.x[beads.segments[:, side]] for side in range(2))
    lines[:, :3], lines[:, 4:7] = np.minimum(one, other), np.maximum(one, other)
    found = []
    for wider in (1.0, BESIDE):
        around = np.zeros((len(places), 8))
        around[:, :3], around[:, 4:7] = places - wider * reach, places + wider * reach
        found.append(np.flatnonzero(meeting_any(plant(around), lines)))
    moving = np.zeros(len(state.x), dtype=np.bool_)
    moving[beads.segments[found[0]]] = True
    return Part(moving, found[1])
