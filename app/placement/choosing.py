"""Which mode of placement a program has."""

from __future__ import annotations

from app.placement.modes import Mode
from app.placement.standing import Standing
from app.program.model import Program


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
    mode: Mode = "rows" if wished == "auto" else wished
    if program.layout.dimensions == 2 and mode != "rows":
        return "rows" if mode == "layers" else "ground"
    return mode
