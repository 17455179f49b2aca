"""Hyperedges that would end at the same place of an item get places of their own beside each other.

Each is wanted where its hyperedge goes, and parallel ones in the same order at both ends. Slots are
assigned so that the sum of the squared distances from there is least (a linear assignment).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from app.arrays import Floats, Indices
from app.placement.placement import Placement
from app.placement.slots import NOTHING, Slots, default_slots, point_slots
from app.placement.turning import matrices
from app.program.model import Program

PITCHES = (2.0, 1.6, 1.3, 1.05)
"""Between slots, over two radii and the clearance: the first with as many as are wanted, on top if
that can be. Where even the last has too few, some share a slot, and are reported as conflicts."""

MOST_ASSIGNED = 400
"""In one assignment, whose time is cubic; more take the slots in the order of their angles."""


def is_spread(program: Program) -> bool:
    """Whether ends are spread: the paper's curves, and those that nobody proves, stay exact."""
    layout = program.layout
    return (
        layout.dimensions == 3
        and layout.curves in {None, "steiner"}
        and layout.fidelity != "paper"
        and layout.clearance is not None
    )


def spread(program: Program, placement: Placement, held: NDArray[np.bool_]) -> Placement:
    """The placement with ends that share an attachment point apart, but for those ``held`` (a,)."""
    ends = [end for hyperedge in program.hyperedges for end in hyperedge.attachments]
    points: dict[tuple[int, str | None], list[int]] = {}
    for row, (item, end) in enumerate(zip(placement.attachment_items.tolist(), ends, strict=True)):
        points.setdefault((item, end.point), []).append(row)
    crowded = {
        key: np.array(rows)
        for key, rows in points.items()
        if len(rows) > 1 and not held[rows].all()
    }
    if not crowded:
        return placement
    wanted = _Wanted.of(program, placement)
    positions = placement.attachment_positions.copy()
    directions = placement.attachment_directions.copy()
    for (item, point), rows in crowded.items():
        new = rows[~held[rows]]
        frame = wanted.frames[item]
        taken = (positions[rows[held[rows]]] - placement.centers[item]) @ frame
        local = (positions[new[0]] - placement.centers[item]) @ frame
        outward = directions[new[0]] @ frame
        thickness = 2 * float(placement.radii[wanted.owners[rows]].max())
        thickness += program.layout.clearance or 0.0
        size = tuple(placement.sizes[item].tolist())
        tiers = [
            default_slots(placement.solids[item], size, len(rows), pitch * thickness, thickness / 2)
            if point is None
            else (
                point_slots(tuple(local), tuple(outward), size, len(rows), pitch * thickness),
                NOTHING,
            )
            for pitch in PITCHES
        ]
        offers = [top for top, _ in tiers] + [np.concatenate(both) for both in tiers]
        for offer in offers:
            places, normals = free_slots(offer, taken, thickness)
            if len(places) >= len(new):
                break
        if len(places) == 0:
            continue
        chosen = assigned(wanted.of_rows(new, item, places, local), places)
        positions[new] = places[chosen] @ frame.T + placement.centers[item]
        directions[new] = normals[chosen] @ frame.T
    return replace(placement, attachment_positions=positions, attachment_directions=directions)


class _Wanted:
    """Where the ends of hyperedges would like to be.

    ``owners`` (a,) are their hyperedges, ``towards`` (a, 3) unit vectors from their items to the
    middle of what else their hyperedge joins, and ``shifts`` (h, 3) sideways ways, in steps, that
    keep parallel hyperedges apart; in the world. ``frames`` (n, 3, 3) are the items' axes.
    """

    def __init__(self, placement: Placement, shifts: Floats) -> None:
        starts, items = placement.attachment_starts, placement.attachment_items
        counts = np.diff(starts)
        self.frames = matrices(placement.rotations)
        self.owners = np.repeat(np.arange(len(counts)), counts)
        self.shifts = shifts
        centers = placement.centers[items]
        sums = np.add.reduceat(centers, starts[:-1], axis=0)
        others = (sums[self.owners] - centers) / (counts[self.owners] - 1)[:, None]
        self.towards = others - centers
        lengths = np.linalg.norm(self.towards, axis=1, keepdims=True)
        self.towards = np.divide(
            self.towards, lengths, out=np.zeros_like(self.towards), where=lengths > 1e-9
        )

    @classmethod
    def of(cls, program: Program, placement: Placement) -> _Wanted:
        """All ends of a program."""
        items, starts = placement.attachment_items.tolist(), placement.attachment_starts.tolist()
        groups: dict[tuple[int, ...], list[int]] = {}
        for number in range(len(program.hyperedges)):
            joined = tuple(sorted(set(items[starts[number] : starts[number + 1]])))
            groups.setdefault(joined, []).append(number)
        shifts = np.zeros((len(program.hyperedges), 3))
        for joined, members in groups.items():
            way = placement.centers[joined[-1]] - placement.centers[joined[0]]
            sideways = np.array([-way[1], way[0], 0.0])
            length = float(np.linalg.norm(sideways))
            sideways = sideways / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
            ranks = np.arange(len(members)) - (len(members) - 1) / 2
            shifts[members] = ranks[:, None] * sideways
        return cls(placement, shifts)

    def of_rows(self, rows: Indices, item: int, places: Floats, anchor: Floats) -> Floats:
        """Where these ends of an item would like to be (r, 3), in the item's axes.

        Towards what they join, half as far as the slots ``places`` (k, 3) about the ``anchor``
        reach, and sideways by steps about as wide as the slots are apart.
        """
        frame = self.frames[item]
        reach = np.abs(places - anchor).max(axis=0)
        step = float(np.linalg.norm(places[: len(rows) + 1] - anchor, axis=1).max(initial=0.0))
        step /= max(np.sqrt(len(rows)), 1.0)
        sideways = self.shifts[self.owners[rows]] @ frame * step
        return np.asarray(anchor + 0.5 * reach * (self.towards[rows] @ frame) + sideways)


def free_slots(slots: Slots, taken: Floats, apart: float) -> tuple[Floats, Floats]:
    """Places and directions (k, 3) of the slots that are ``apart`` from those ``taken`` (t, 3)."""
    places, normals = slots[:, :3], slots[:, 3:]
    if len(taken) == 0 or len(places) == 0:
        return places, normals
    free = np.linalg.norm(places[:, None] - taken[None], axis=2).min(axis=1) >= apart - 1e-9
    return places[free], normals[free]


def assigned(
    wanted: Floats, places: Floats, costs: Floats | None = None
) -> Sequence[int] | Indices:
    """The slot of each end ``wanted`` (r, 3); the last one for those beyond their number.

    Of the ``places`` (k, 3) the first are chosen among, twice as many as are wanted; with ``costs``
    (r, k), which are added to squares of distances, all of them.
    """
    count = len(wanted)
    # The best ones, and some to choose among.
    offered = places if costs is not None else places[: max(2 * count, count + 8)]
    if count > len(offered) or count > MOST_ASSIGNED:
        order = np.argsort(np.arctan2(wanted[:, 1], wanted[:, 0]), kind="stable")
        chosen = np.empty(count, dtype=np.int64)
        near = np.arange(min(count, len(places)))
        angles = np.arctan2(places[near, 1], places[near, 0])
        ranked = near[np.argsort(angles, kind="stable")]
        chosen[order] = ranked[np.minimum(np.arange(count), len(ranked) - 1)]
        return chosen
    from scipy.optimize import linear_sum_assignment

    squares = ((wanted[:, None] - offered[None]) ** 2).sum(axis=2)
    if costs is not None:
        squares += costs
    # Equal costs are decided by the order of the document, not by the library's.
    squares += 1e-9 * np.arange(len(offered)) + 1e-12 * np.arange(count)[:, None] * np.arange(
        len(offered)
    )
    return np.asarray(linear_sum_assignment(squares)[1])
