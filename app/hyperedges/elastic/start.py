"""Where chains begin: along short trees, in space or as arches over the ground."""

from __future__ import annotations

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.grouped import rows_of, starts_of
from app.hyperedges.elastic.beads import SPACING
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.polylines import Polylines
from app.hyperedges.elastic.sides import sides_of
from app.hyperedges.steiner.trees import short_trees
from app.placement.placement import Placement

UPWARDS = 0.7
"""Height of a unit direction from which on an attachment points upwards."""

RISE, FAR = 0.19, 170.0
"""Height of an arch over its span, up to a span of so many radii.

Beyond that arches rise by the square root of their spans: else the widest would stand before all
that is behind them.
"""

BULGE = 0.1
"""The same of an arch before or behind a sheet."""

PIECES = 16
"""Straight pieces of an arch at the start."""


TURN = 3.0
"""How far below where it ends to be straight a tube turns, over its radius."""

WIDE = 12.0
"""Least length of the handles with which a chain begins at attachments, over the tube's radius."""


def chains_of(
    placement: Placement, chosen: Indices, join_heights: Floats, on_ground: bool
) -> tuple[Chains, Floats]:
    """The chains of the hyperedges ``chosen`` (k,), along short trees, and joins (j, 3).

    ``join_heights`` (k,): where joins are held, NaN where they are free. Where all items stand
    ``on_ground`` no bead comes nearer to it than its tube's radius, unless an attachment leads
    there, or so near to it that a tube could not turn.

    On a sheet every hyperedge is an arch, before the sheet or behind it.
    """
    counts = np.diff(placement.attachment_starts)[chosen]
    rows = rows_of(placement.attachment_starts, chosen)
    starts = starts_of(counts)
    radii = placement.radii[chosen]
    positions = np.ascontiguousarray(placement.attachment_positions[rows])
    directions = np.ascontiguousarray(placement.attachment_directions[rows])
    is_sheet = placement.mode == "sheet"
    hung = np.full(len(chosen), is_sheet)
    if placement.stands and len(chosen):
        hung = np.minimum.reduceat(directions[:, 2], starts[:-1]) > UPWARDS
    flat = [0, 2] if is_sheet else [0, 1]
    numbers = np.arange(len(chosen) + 1)
    join_starts, edge_starts = starts - 2 * numbers, 2 * starts - 3 * numbers
    joins = np.zeros((int(join_starts[-1]), 3))
    edges = np.zeros((int(edge_starts[-1]), 2), dtype=np.int64)
    bases = positions + directions * _stubs(radii, counts)[:, None]
    for kind, axes in ((hung, flat), (~hung, [0, 1, 2])):
        some = np.flatnonzero(kind)
        points = np.ascontiguousarray(bases[rows_of(starts, some)][:, axes])
        trees = short_trees(points, starts_of(counts[some]))
        joins[rows_of(join_starts, some)[:, None], axes] = trees.joins
        edges[rows_of(edge_starts, some)] = trees.edges
    owners = np.repeat(np.arange(len(chosen)), np.diff(edge_starts))
    ends = np.where(
        edges < counts[owners, None],
        join_starts[-1] + starts[owners, None] + edges,
        join_starts[owners, None] + edges - counts[owners, None],
    )
    # A tube that leaves downwards needs room to turn before it comes up again.
    turns = TURN * np.repeat(radii, counts) * np.maximum(-directions[:, 2], 0.0)
    lowest = np.minimum.reduceat(bases[:, 2], starts[:-1]) if len(chosen) else radii
    turned = np.minimum.reduceat(bases[:, 2] - turns, starts[:-1]) if len(chosen) else radii
    ways = np.tile([0.0, 0.0, 1.0], (len(chosen), 1))
    if is_sheet and len(chosen):
        nodes = np.concatenate([joins, bases])[:, flat]
        ways[:] = 0.0
        ways[:, 1] = sides_of(nodes[ends[:, 0]], nodes[ends[:, 1]], owners, len(chosen))
    floors = np.where((lowest >= radii) & on_ground, np.minimum(radii, turned), -np.inf)
    chains = Chains(
        ends=ends,
        local_ends=edges,
        owners=owners,
        join_starts=join_starts,
        attachment_starts=starts,
        positions=positions,
        directions=directions,
        radii=radii,
        hung=hung,
        ways=ways,
        heights=join_heights,
        floors=floors,
    )
    if len(chosen):
        _raise(chains, bases, joins)
    return chains, joins


def curvatures_of(chains: Chains) -> Floats:
    """Of arches over their spans, (h,); 0 where nothing hangs.

    One curvature for all chains of a hyperedge, so that they meet in one dome: a parabola over a
    span d that rises by R d has the second derivative 8 R / d.
    """
    spans, rises = _arches(chains)
    return np.where(chains.hung, 8.0 * rises / spans, 0.0)


def start_lines(chains: Chains, joins: Floats) -> Polylines:
    """Polylines from end to end of each chain: arches where it hangs over the ground.

    Else they are cubics that leave attachments along their directions, and joins straight; on a
    sheet with the arch added.
    """
    counts = np.diff(chains.attachment_starts)
    bases = chains.positions + chains.directions * _stubs(chains.radii, counts)[:, None]
    nodes = np.concatenate([joins, bases])
    first, last = nodes[chains.ends[:, 0]], nodes[chains.ends[:, 1]]
    share = np.linspace(0.0, 1.0, PIECES + 1)[:, None]
    rest = 1.0 - share
    lines = first[:, None] + share * (last - first)[:, None]
    ways = chains.ways[chains.owners]
    spans = np.linalg.norm(_across(last - first, ways), axis=1)
    bends = 0.5 * curvatures_of(chains)[chains.owners] * spans**2
    arches = (bends[:, None, None] * share * rest) * ways[:, None]
    lines += arches
    handles = []
    outward = np.concatenate([np.zeros_like(joins), chains.directions])
    for here, there, node in ((first, last, 0), (last, first, 1)):
        far = np.linalg.norm(there - here, axis=1)
        least = WIDE * chains.radii[chains.owners]
        direction = outward[chains.ends[:, node]] * np.maximum(far / 3.0, least)[:, None]
        at_join = (chains.ends[:, node] < len(joins))[:, None]
        handles.append(here + np.where(at_join, (there - here) / 3.0, direction))
    weights = (rest**3, 3 * rest**2 * share, 3 * rest * share**2, share**3)
    corners = (first, handles[0], handles[1], last)
    cubics = sum(weight * corner[:, None] for weight, corner in zip(weights, corners, strict=True))
    # With the attachment itself before its base.
    whole = np.empty((len(lines), PIECES + 3, 3))
    upwards = chains.hung[chains.owners] & (ways[:, 2] > 0.0)
    whole[:, 1:-1] = np.where(upwards[:, None, None], lines, cubics + arches)
    places = np.concatenate([joins, chains.positions])
    whole[:, 0], whole[:, -1] = places[chains.ends[:, 0]], places[chains.ends[:, 1]]
    size = PIECES + 3
    return Polylines(whole.reshape(-1, 3), np.arange(len(lines) + 1) * size)


def _stubs(radii: Floats, counts: Indices) -> Floats:
    """How far each attachment's tube goes straight at the start, (a,)."""
    return np.repeat(SPACING * radii, counts)


def _arches(chains: Chains) -> tuple[Floats, Floats]:
    """Diagonals of hyperedges seen along their ways, and how high arches rise over these.

    (h,) each.
    """
    starts = chains.attachment_starts[:-1]
    lows = np.minimum.reduceat(chains.positions, starts, axis=0)
    highs = np.maximum.reduceat(chains.positions, starts, axis=0)
    wide = np.linalg.norm(_across(highs - lows, chains.ways), axis=1)
    spans = np.maximum(wide, 2.0 * SPACING * chains.radii)
    rises = np.where(chains.ways[:, 2] > 0.0, RISE, BULGE)
    return spans, rises * np.minimum(1.0, np.sqrt(FAR * chains.radii / spans))


def _across(vectors: Floats, ways: Floats) -> Floats:
    """Vectors (n, 3) without what they have along the axes that ``ways`` (n, 3) are along."""
    return np.where(ways == 0.0, vectors, 0.0)


def _raise(chains: Chains, bases: Floats, joins: Floats) -> None:
    """Give the joins of arches a height: that of the arch over their attachments."""
    counts = np.diff(chains.join_starts)
    owners = np.repeat(np.arange(len(counts)), counts)
    hung: Flags = chains.hung[owners]
    middles = np.add.reduceat(bases, chains.attachment_starts[:-1], axis=0)
    middles /= np.diff(chains.attachment_starts)[:, None]
    spans, rises = _arches(chains)
    tops = middles + (rises * spans)[:, None] * chains.ways
    along = hung[:, None] & (chains.ways[owners] != 0.0)
    joins[along] = tops[owners][along]
    held = ~np.isnan(chains.heights[owners])
    joins[held, 2] = chains.heights[owners][held]
