"""Which siblings belong together: what hyperedges join, among the contents of each item."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

from app.notations.notation import Notation
from app.placement.family import Family
from app.program.model import Program


@dataclass(frozen=True, slots=True)
class Joined:
    """For each parent (-1: the roots) the groups of its children that one hyperedge joins.

    A hyperedge joins children that it ends at, or at something in them; two or more, each once.
    ``thickness`` is that of the thickest tube with its clearance, document units.
    """

    groups: dict[int, list[list[int]]]
    thickness: float


def joined(program: Program, relations: Family, notation: Notation) -> Joined:
    """What the hyperedges of a program join."""
    numbers = {item.id: number for number, item in enumerate(program.items)}
    parents = relations.parents
    groups: dict[int, list[list[int]]] = defaultdict(list)
    thickest = 0.0
    for hyperedge in program.hyperedges:
        radius = hyperedge.radius or notation.hyperedge_style(hyperedge.kind).radius
        thickest = max(thickest, radius)
        found: dict[int, dict[int, None]] = defaultdict(dict)
        for end in hyperedge.attachments:
            child = numbers[end.item]
            while child >= 0 and child not in found[parents[child]]:
                found[parents[child]][child] = None
                child = parents[child]
        for parent, children in found.items():
            if len(children) > 1:
                groups[parent].append(list(children))
    return Joined(groups, 2 * thickest + (program.layout.clearance or 0.0))
