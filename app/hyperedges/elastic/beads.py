"""Chains as beads, evenly spaced: what is moved."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.polylines import Polylines, lengths_of, resample

SPACING = 4.0
"""Distance between beads, over the tube's radius."""


MOST_OF_CHAIN, MOST = 2048, 2_000_000
"""Beads of a chain, and of all chains, at most; beyond that they lie farther apart."""

NEVER_NEARER = 0.8
"""Least distance between neighbours, over what it was when they were spaced."""


class Beads(NamedTuple):
    """b beads: the nodes of `Chains`, then the inner beads of one chain after another.

    After these come the ``fixed`` beads, of hyperedges that keep their curves.

    The inner beads of chain k are ``starts[k]`` to ``starts[k + 1]`` (c + 1,); its segments, the
    straight lines between its beads, ``segment_starts[k]`` to ``segment_starts[k + 1]``; behind
    those of all chains come the segments of what is fixed. ``segments`` (s, 2) are beads;
    ``chains`` (s,) what they are of, ``owners`` (s,) the hyperedges, those that are fixed after all
    others; ``radii`` (s,).

    ``links`` (b, 3) are neighbours along chains: two, three at joins, one at attachments, -1 where
    there is none; ``degrees`` (b,) count them. ``free`` (b,): 1 where a bead may move, 0 at
    attachments, at the beads next to these, which keep a tube's end straight, and where fixed.
    ``thickness`` (b,): the tube's radius. ``lows`` and ``highs`` (b,): the least and the largest
    height. ``lifts`` (b, 3): how far each bead is drawn to where its arch rises in a step, times
    the rate of straightening. ``spans`` (b,): the least distance from neighbours. ``ends`` (c, 2)
    are the beads at chains' ends.
    """

    ends: Indices
    starts: Indices
    segment_starts: Indices
    segments: Indices
    chains: Indices
    owners: Indices
    radii: Floats
    links: Indices
    degrees: Indices
    free: Floats
    thickness: Floats
    lows: Floats
    highs: Floats
    lifts: Floats
    spans: Floats
    fixed: int


class Fixed(NamedTuple):
    """Polylines of hyperedges that keep their curves.

    ``positions`` (f, 3); ``segments`` (g, 2) of these; ``owners`` (g,), numbered from the number of
    hyperedges that move; ``radii`` (g,).
    """

    positions: Floats
    segments: Indices
    owners: Indices
    radii: Floats

    @staticmethod
    def nothing() -> Fixed:
        """No curve is kept."""
        none = np.zeros(0, dtype=np.int64)
        return Fixed(np.zeros((0, 3)), np.zeros((0, 2), dtype=np.int64), none, np.zeros(0))


def lay_beads(
    chains: Chains, lines: Polylines, fixed: Fixed, curvatures: Floats
) -> tuple[Beads, Floats]:
    """Beads evenly along ``lines``, and their positions (b, 3).

    ``curvatures`` (h,): of the arches that hyperedges are drawn to, one over document units.
    """
    joins, attachments = chains.joins, len(chains.positions)
    nodes = joins + attachments
    radii = chains.radii[chains.owners]
    lengths = lengths_of(lines)
    attached = chains.ends >= joins
    least = 2 + attached.sum(axis=1)
    wanted = np.minimum(lengths / (SPACING * radii), MOST_OF_CHAIN)
    wanted *= min(1.0, MOST / max(float(wanted.sum()), 1.0))
    counts = np.maximum(least, np.rint(wanted)).astype(np.int64)
    segment_starts = np.concatenate([[0], np.cumsum(counts)])
    starts = nodes + segment_starts - np.arange(len(counts) + 1)
    moving = int(starts[-1])
    x = np.empty((moving + len(fixed.positions), 3))
    resample(lines.points, lines.starts, counts, starts, x)
    x[moving:] = fixed.positions
    x[joins:nodes] = chains.positions
    for side, rows in enumerate((lines.starts[:-1], lines.starts[1:] - 1)):
        # All chains of a join begin or end at the same place.
        at_join = ~attached[:, side]
        x[chains.ends[at_join, side]] = lines.points[rows[at_join]]
    firsts, lasts = starts[:-1], starts[1:] - 1
    spans = lengths / counts
    free = np.ones(len(x))
    free[joins:nodes] = 0.0
    free[moving:] = 0.0
    for side, beside in enumerate((firsts, lasts)):
        at = attached[:, side]
        number = chains.ends[at, side] - joins
        x[beside[at]] = chains.positions[number] + (
            np.minimum(spans[at], SPACING * radii[at])[:, None] * chains.directions[number]
        )
        free[beside[at]] = 0.0
    links, degrees = _link(len(x), nodes, moving, chains.ends, firsts, lasts)
    chain = np.repeat(np.arange(len(counts)), counts)
    step = np.arange(segment_starts[-1]) - segment_starts[chain]
    inner = starts[chain] + step
    segments = np.stack(
        [
            np.where(step == 0, chains.ends[chain, 0], inner - 1),
            np.where(step == counts[chain] - 1, chains.ends[chain, 1], inner),
        ],
        axis=1,
    )
    thickness = np.zeros(len(x))
    thickness[nodes:moving] = np.repeat(radii, counts - 1)
    thickness[chains.ends] = radii[:, None]
    if len(fixed.segments):
        thickness[moving + fixed.segments] = fixed.radii[:, None]
    least_spans = np.zeros(len(x))
    near = NEVER_NEARER * np.minimum(spans, SPACING * radii)
    least_spans[nodes:moving] = np.repeat(near, counts - 1)
    lifts = _lifts(chains, counts, 0.5 * curvatures[chains.owners] * spans**2, len(x))
    lows, highs = _heights(chains, starts, counts, free)
    beads = Beads(
        ends=chains.ends,
        starts=starts,
        segment_starts=segment_starts,
        segments=np.concatenate([segments, moving + fixed.segments]),
        chains=np.concatenate([chain, len(counts) + fixed.owners]),
        owners=np.concatenate([chains.owners[chain], fixed.owners]),
        radii=np.concatenate([radii[chain], fixed.radii]),
        links=links,
        degrees=degrees,
        free=free,
        thickness=thickness,
        lows=lows,
        highs=highs,
        lifts=lifts,
        spans=least_spans,
        fixed=len(fixed.positions),
    )
    return beads, x


def _lifts(chains: Chains, counts: Indices, pulls: Floats, size: int) -> Floats:
    """How far beads are drawn, (``size``, 3): those of each chain by its ``pulls`` (c,)."""
    joins, nodes = chains.joins, chains.joins + len(chains.positions)
    lifts = np.zeros((size, 3))
    drawn = pulls[:, None] * chains.ways[chains.owners]
    for side in range(2):
        np.add.at(lifts, chains.ends[:, side], drawn / 3.0)
    lifts[joins:nodes] = 0.0
    inner = np.repeat(drawn, counts - 1, axis=0)
    lifts[nodes : nodes + len(inner)] = inner
    return lifts


def _heights(
    chains: Chains, starts: Indices, counts: Indices, free: Floats
) -> tuple[Floats, Floats]:
    """The least and the largest heights of beads, (b,).

    Joins, or the middles of curves between two attachments, are held where that is wished for.
    """
    lows, highs = np.full(len(free), -np.inf), np.full(len(free), np.inf)
    floors = chains.floors[chains.owners]
    lows[starts[0] : starts[-1]] = np.repeat(floors, counts - 1)
    lows[chains.ends] = floors[:, None]
    wanted = np.repeat(chains.heights, np.diff(chains.join_starts))
    held = np.flatnonzero(~np.isnan(wanted))
    lows[held] = highs[held] = wanted[held]
    alone = (chains.ends >= chains.joins).all(axis=1) & ~np.isnan(chains.heights[chains.owners])
    middles = (starts[:-1] + (counts - 1) // 2)[alone]
    lows[middles] = highs[middles] = chains.heights[chains.owners[alone]]
    # What does not move is where it is.
    lows[free == 0.0], highs[free == 0.0] = -np.inf, np.inf
    return lows, highs


def lines_of(beads: Beads, x: Floats) -> Polylines:
    """The polylines through the beads of each chain."""
    counts = np.diff(beads.segment_starts)
    starts = np.concatenate([[0], np.cumsum(counts + 1)])
    chain = np.repeat(np.arange(len(counts)), counts + 1)
    step = np.arange(starts[-1]) - starts[chain]
    bead = beads.starts[chain] + step - 1
    bead = np.where(step == 0, beads.ends[chain, 0], bead)
    bead = np.where(step == counts[chain], beads.ends[chain, 1], bead)
    return Polylines(np.ascontiguousarray(x[bead]), starts)


def movable(beads: Beads, owners: Flags) -> Flags:
    """Which beads (b,) may move, where the hyperedges ``owners`` (h,) do."""
    found = np.zeros(len(beads.free), dtype=np.bool_)
    count = int(beads.segment_starts[-1])
    found[beads.segments[:count][owners[beads.owners[:count]]]] = True
    return found & (beads.free > 0)


def _link(
    count: int, nodes: int, moving: int, ends: Indices, firsts: Indices, lasts: Indices
) -> tuple[Indices, Indices]:
    links = np.full((count, 3), -1)
    degrees = np.zeros(count, dtype=np.int64)
    inner = np.arange(nodes, moving)
    links[inner, 0], links[inner, 1] = inner - 1, inner + 1
    degrees[inner] = 2
    links[firsts, 0], links[lasts, 1] = ends[:, 0], ends[:, 1]
    # A node's links in the order of its chains.
    node = ends.T.ravel()
    beside = np.concatenate([firsts, lasts])
    order = np.lexsort((np.tile(np.arange(len(ends)), 2), node))
    node, beside = node[order], beside[order]
    new = np.concatenate([[0], np.cumsum(np.bincount(node, minlength=nodes))])[:-1]
    links[node, np.arange(len(node)) - new[node]] = beside
    degrees[:nodes] = np.bincount(node, minlength=nodes)
    return links, degrees
