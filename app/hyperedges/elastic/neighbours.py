"""Which segments of chains may come too near to each other, or to items, within a few steps.

Lists that stay valid until a bead has gone half of its *skin* (Verlet 1967), which is as thick as
its tube is: thin tubes have short lists beside thick ones. They are found with trees of boxes,
whatever the sizes of what is in them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.hyperedges.clearance.box_tree import Tree, meeting, plant
from app.hyperedges.elastic.beads import SPACING, Beads
from app.hyperedges.elastic.capsules import within
from app.hyperedges.elastic.chains import Chains
from app.hyperedges.elastic.relaxation import Near
from app.hyperedges.elastic.rounded_boxes import Boxes
from app.hyperedges.stopping import unchecked

MOST_NEAR = 8_000_000
"""Pairs of segments, or of a segment and a box: some gigabyte of memory."""

TOGETHER = 7
"""Segments of two chains that meet at a join count as one there: so many in all."""

WIDER = 0.5
"""Room for how far curves run beside their beads, over the tube's radius."""

OWN = 3.0
"""A hyperedge's own items count farther from its attachments than this times its room."""

FROM_ATTACHMENT, FROM_JOIN = 3.0, 2.6
"""How far a join is kept from its attachments, and from other joins, in distances of beads."""

AT_ONCE = 8192
"""Segments between two looks whether to go on."""


@dataclass(frozen=True, slots=True, eq=False)
class Items:
    """Boxes of items to keep clear of.

    ``owners`` (m,) are the boxes' items; ``tree`` is over the boxes. ``ignored`` (k, 2), sorted:
    hyperedges, and items that are not in their way at all. ``own``: attachments, and their items
    and the parts of these, (n,) each, which do not count near them.
    """

    boxes: Boxes
    owners: Indices
    tree: Tree | None
    ignored: Indices
    own: tuple[Indices, Indices]

    @staticmethod
    def of(boxes: Boxes, owners: Indices, ignored: Indices, own: tuple[Indices, Indices]) -> Items:
        """With a tree over them."""
        if len(owners) == 0:
            return Items(boxes, owners, None, ignored, own)
        reach = np.einsum("kij,kj->ki", np.abs(boxes.rotations), boxes.halves)
        reach += boxes.roundings[:, None]
        nothing = np.zeros((len(owners), 1))
        corners = [boxes.centers - reach, nothing, boxes.centers + reach, nothing]
        return Items(boxes, owners, plant(np.hstack(corners)), ignored, own)


def find_near(
    x: Floats,
    beads: Beads,
    chains: Chains,
    items: Items,
    rooms: Floats,
    stretch: Floats,
    clearance: float,
    moving: Flags,
    size: float,
    skin: float,
    among: Indices | None = None,
    check: Callable[[], None] = unchecked,
) -> Near:
    """What may come too near to what moves, until a bead has gone half of ``skin``.

    ``rooms`` (s,), ``size`` and ``skin`` as for `app.hyperedges.elastic.relaxation.relax`;
    ``stretch`` (c,) as for `app.hyperedges.elastic.run.State`; ``moving`` (b,). Only the segments
    ``among`` (k,), ascending, count, if they are given. ``check`` is called now and then, and may
    raise to end it. Raises `TooManyPairs` where there are more than `MOST_NEAR`.
    """
    some = np.arange(len(beads.segments)) if among is None else among
    segments, of = beads.segments[some], beads.chains[some]
    around = np.zeros((len(some), 8))
    reach = rooms * size + (WIDER + 0.5 * skin) * beads.radii
    one, other, margin = x[segments[:, 0]], x[segments[:, 1]], reach[some][:, None]
    around[:, :3] = np.minimum(one, other) - margin
    around[:, 4:7] = np.maximum(one, other) + margin
    asked = moving[segments[:, 0]] | moving[segments[:, 1]]
    pairs = np.zeros((0, 2), dtype=np.int64)
    if asked.any():
        beside = _within_reach(around, asked)
        boxes, asking, of = around[beside], asked[beside], of[beside]
        tree = plant(boxes)
        order = tree.order[asking[tree.order]]
        parts, count = [], 0
        for begin in range(0, len(order), AT_ONCE):
            check()
            some_of = order[begin : begin + AT_ONCE]
            part = meeting(tree, boxes, some_of, (of, of), asking, MOST_NEAR - count)
            part = some[beside[part]]
            part = part[within(x, beads.segments, part, reach)]
            parts.append(part[~_beside_a_join(part, beads)])
            count += len(parts[-1])
        pairs = np.concatenate(parts)
        if len(parts) > 1:
            pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    rows = np.flatnonzero(asked)
    near, exempt = _near_items(x, around[rows], some[rows], beads, chains, items, clearance)
    apart, distances = _apart(chains, stretch)
    return Near(pairs, near, exempt, apart, distances)


def _within_reach(around: Floats, asked: Flags) -> Indices:
    """Which boxes (k, 8) meet the one around all that are ``asked`` for (k,)."""
    low, high = around[asked, :3].min(axis=0), around[asked, 4:7].max(axis=0)
    meets = (around[:, :3] <= high) & (around[:, 4:7] >= low)
    return np.flatnonzero(meets[:, 0] & meets[:, 1] & meets[:, 2])


def _beside_a_join(pairs: Indices, beads: Beads) -> Flags:
    """Which pairs (m, 2) of segments are on two chains of one join, and both beside it."""
    same = np.flatnonzero(beads.owners[pairs[:, 0]] == beads.owners[pairs[:, 1]])
    found = np.zeros(len(pairs), dtype=np.bool_)
    chain = beads.chains[pairs[same]]
    steps = pairs[same] - beads.segment_starts[chain]
    counts = np.diff(beads.segment_starts)[chain]
    for one in range(2):
        for other in range(2):
            meet = beads.ends[chain[:, 0], one] == beads.ends[chain[:, 1], other]
            here = counts[:, 0] - 1 - steps[:, 0] if one else steps[:, 0]
            there = counts[:, 1] - 1 - steps[:, 1] if other else steps[:, 1]
            found[same[meet & (here + there < TOGETHER)]] = True
    return found


def _near_items(
    x: Floats,
    around: Floats,
    asking: Indices,
    beads: Beads,
    chains: Chains,
    items: Items,
    clearance: float,
) -> tuple[Indices, Floats]:
    """Pairs (n, 2) of a segment and a box, and where the box does not count, (n, 4).

    That is where the segment's chain attaches to the box's item. For the segments ``asking`` (k,),
    in boxes ``around`` (k, 8).
    """
    if items.tree is None or len(asking) == 0:
        return np.zeros((0, 2), dtype=np.int64), np.zeros((0, 4))
    around[:, :3] -= 0.5 * clearance
    around[:, 4:7] += 0.5 * clearance
    numbers, strangers = np.arange(len(asking)), np.full(len(items.owners), -1)
    near = meeting(items.tree, around, numbers, (numbers, strangers), most=MOST_NEAR)
    near[:, 0] = asking[near[:, 0]]
    ends_of, own_items = items.own
    count = int(max(items.owners.max(), own_items.max(initial=0))) + 1
    keys = beads.owners[near[:, 0]] * count + items.owners[near[:, 1]]
    if len(items.ignored):
        kept = ~np.isin(keys, items.ignored[:, 0] * count + items.ignored[:, 1])
        near, keys = near[kept], keys[kept]
    exempt = np.zeros((len(near), 4))
    owners = np.repeat(np.arange(len(chains.radii)), np.diff(chains.attachment_starts))
    attached = owners[ends_of] * count + own_items
    order = np.argsort(attached, kind="stable")
    begins, ends = (np.searchsorted(attached[order], keys, side) for side in ("left", "right"))
    order = ends_of[order]
    own = np.flatnonzero(ends > begins)
    if len(own):
        middles = x[beads.segments[near[own, 0]]].mean(axis=1)
        best = np.full(len(own), np.inf)
        chain = beads.chains[near[own, 0]]
        for step in range(int((ends - begins).max())):
            row = order[np.minimum(begins[own] + step, ends[own] - 1)]
            far = np.linalg.norm(chains.positions[row] - middles, axis=1)
            # Another chain of the hyperedge has to keep clear of the item there too.
            far[(chains.ends[chain] != chains.joins + row[:, None]).all(axis=1)] = np.inf
            nearer = far < best
            best[nearer] = far[nearer]
            exempt[own[nearer], :3] = chains.positions[row[nearer]]
        at_own = own[best < np.inf]
        exempt[at_own, 3] = OWN * (beads.radii[near[at_own, 0]] + clearance)
    return near, exempt


def _apart(chains: Chains, stretch: Floats) -> tuple[Indices, Floats]:
    """Ends of chains that are to stay apart, (k, 2), and how far, (k,)."""
    at_join = chains.ends < chains.joins
    rows = np.flatnonzero(at_join.any(axis=1))
    far = np.where(at_join[rows].all(axis=1), FROM_JOIN, FROM_ATTACHMENT)
    far = far * stretch[rows]
    return chains.ends[rows], far * SPACING * chains.radii[chains.owners[rows]]
