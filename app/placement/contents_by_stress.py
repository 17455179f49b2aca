"""Contents of an item, and roots, placed by what hyperedges join: on the ground."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.placement.by_stress import by_stress
from app.placement.enclosing import Contents
from app.placement.joined import Joined
from app.placement.modes import Mode
from app.placement.rooms import edge, edge_of_fixed
from app.placement.sized import Place, Sized
from app.placement.still import Block
from app.placement.stress.pairs import Progress


@dataclass(frozen=True, slots=True)
class Within:
    """What hyperedges join among the contents of one item, to place these by stress."""

    joined: Sequence[Sequence[int]]
    thickness: float
    progress: Progress
    spacing: float = 1.0


@dataclass(frozen=True, slots=True)
class Stress:
    """What hyperedges join, to place items by stress, in a ``mode`` other than rows."""

    mode: Mode
    joined: Joined
    progress: Progress
    spacing: float = 1.0

    def within(self, parent: int) -> Within | None:
        """What is joined among the contents of an item (-1: the roots); ``None`` if nothing is.

        What an item contains stands in rows but on the ground.
        """
        groups = self.joined.groups.get(parent)
        if not groups or (parent >= 0 and self.mode != "ground"):
            return None
        return Within(groups, self.joined.thickness, self.progress, self.spacing)


DEEPER = 1.4
"""How far a tray is stretched at most, to be as deep as its neighbours."""


def contain_by_stress(
    sized: Sequence[Sized], children: Sequence[int], blocks: Sequence[Block], stress: Within
) -> Contents:
    """Children on the ground, by what hyperedges join; those with positions stay."""
    found = by_stress(
        sized,
        children,
        blocks,
        stress.joined,
        stress.thickness,
        "ground",
        stress.progress,
        stress.spacing,
    )
    fixed = [child for child in children if not sized[child].is_free]
    free = [child for block in blocks for child in block.members]
    edges = np.array(
        [edge_of_fixed(sized[child]) for child in fixed]
        + [edge(sized[child], *found[child][:2]) for child in free]
    )
    around = np.concatenate([edges[:, :2].min(axis=0), edges[:, 2:].max(axis=0)])
    x, y = (0.0, 0.0) if fixed else ((around[:2] + around[2:]) / 2).tolist()
    places = {child: (found[child][0] - x, found[child][1] - y) for child in free}
    return Contents(places, around - np.array([x, y, x, y]), fixed=bool(fixed))


def beside_joined(
    blocks: Sequence[Block],
    standing: Mapping[int, Floats],
    stress: Within,
) -> dict[int, Place]:
    """In the middle of what they are joined to: where new ``blocks`` want to be, by first member.

    Nowhere, where they are joined to nothing that is ``standing``.
    """
    new = {child: next(iter(block.members)) for block in blocks for child in block.members}
    beside: dict[int, list[Floats]] = defaultdict(list)
    for group in stress.joined:
        stood = [standing[child] for child in group if child in standing]
        for child in group:
            if stood and child in new:
                beside[new[child]].extend(stood)
    middles = {child: np.mean(edges, axis=0) for child, edges in beside.items()}
    return {
        child: (float(edges[0] + edges[2]) / 2, float(edges[1] + edges[3]) / 2)
        for child, edges in middles.items()
    }
