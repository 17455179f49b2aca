"""Which mode of placement a program has."""

from __future__ import annotations

from app.placement.modes import Mode
from app.placement.standing import Standing
from app.program.model import Program

FEWEST, MOST = 12, 1_000
"""Hyperedges of a program that ``auto`` puts on a sheet: fewer can be followed in rows, and more
take long to relax."""


def mode_of(program: Program, standing: Standing | None) -> Mode:
    """By what items without positions are placed: as before, where the same is asked for.

    What is asked may leave it to us, or may have been too much for layers.
    """
    wishes = program.layout
    if standing is not None:
        before = standing.program.layout
        if (before.placement, before.dimensions) == (wishes.placement, wishes.dimensions):
            return standing.mode
    return wished_mode(program)


def wished_mode(program: Program) -> Mode:
    """The mode that a document asks for.

    A flat drawing is seen from above: there a sheet lies on the ground, and so does space, and
    layers are rows.
    """
    wished = program.layout.placement
    mode: Mode = _suitable(program) if wished == "auto" else wished
    if program.layout.dimensions == 2 and mode != "rows":
        return "rows" if mode == "layers" else "ground"
    return mode


def _suitable(program: Program) -> Mode:
    """A sheet for what looks like a graph, and rows for all else; see docs/placement.md."""
    layout = program.layout
    is_relaxed = (
        layout.curves in {None, "steiner"}
        and layout.fidelity != "paper"
        and layout.clearance is not None
        and layout.routing != "planes"
    )
    is_graph = (
        FEWEST <= len(program.hyperedges) <= MOST
        and not layout.constraints
        and all(item.parent is None and item.position is None for item in program.items)
        and all(
            hyperedge.join_height is None
            and all(end.point is None for end in hyperedge.attachments)
            for hyperedge in program.hyperedges
        )
    )
    return "sheet" if is_relaxed and is_graph else "rows"
