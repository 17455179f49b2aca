"""Which parts of an earlier state of a program are those of the program now."""

from __future__ import annotations

import numpy as np

from app.arrays import Indices
from app.program.model import Program


def former_numbers(program: Program, before: Program) -> Indices:
    """Which hyperedge of ``before`` has the id of each one now, (h,); -1 for new ones."""
    known = {hyperedge.id: number for number, hyperedge in enumerate(before.hyperedges)}
    return np.array(
        [known.get(hyperedge.id, -1) for hyperedge in program.hyperedges], dtype=np.int64
    )
