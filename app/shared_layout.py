"""The layout of a posted document, which answers in several formats have in common."""

from __future__ import annotations

from dataclasses import dataclass

from app.hyperedges.stopping import Spent, nothing_spent
from app.layout import Layout, Progress, lay_out
from app.layout_record import read_layout, write_layout
from app.program.model import Program

FEWEST_HYPEREDGES = 50
"""Fewer are laid out sooner than they are written and read."""


@dataclass(slots=True)
class SharedLayout:
    """What an earlier answer wrote, ``known``, or what this one writes for later ones, ``made``."""

    known: bytes | None = None
    made: bytes | None = None

    def of(self, program: Program, progress: Progress, spent: Spent = nothing_spent) -> Layout:
        """The layout of a program, which is the same to the bit wherever it comes from.

        One that is not complete is not shared: with more time it would be another one.
        """
        if self.known is not None and (laid := read_layout(program, self.known)) is not None:
            return laid
        laid = lay_out(program, progress=progress, spent=spent)
        if laid.complete and len(program.hyperedges) >= FEWEST_HYPEREDGES:
            self.made = write_layout(laid)
        return laid
