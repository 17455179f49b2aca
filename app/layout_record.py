"""Layouts as bytes, so that a stored program looks after a restart as it did before, to the bit.

What can be computed again from the program (solids, labels, attachments) is not in them.
"""

from __future__ import annotations

import io
import zlib
from typing import Any
from zipfile import BadZipFile

import numpy as np

from app.hyperedges.routing import Routing
from app.layout import Layout, shown
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.standing import Standing
from app.program.model import Program

FORM = 1
"""Of the bytes; another form cannot be read, and the program is laid out anew."""

PLACES = ("centers", "rotations", "sizes", "offsets", "turns")
CURVES = (
    "control_points",
    "segment_starts",
    "segment_ends",
    "join_positions",
    "join_tangents",
    "join_starts",
    "join_planes",
    "radii",
)


def write_layout(layout: Layout) -> bytes:
    """The layout as bytes, for `read_layout` with the same program."""
    file = io.BytesIO()
    arrays = {name: getattr(layout.placement, name) for name in PLACES}
    arrays |= {f"routing_{name}": getattr(layout.routing, name) for name in CURVES}
    np.savez(file, form=FORM, hues=layout.hues, **arrays)
    return file.getvalue()


def read_layout(program: Program, data: bytes) -> Layout | None:
    """The layout that was written, or ``None`` where another version wrote it, or it is broken."""
    try:
        arrays = _arrays(data)
        standing = Standing(program, *(arrays[name] for name in PLACES))
        routing = Routing(**{name: arrays[f"routing_{name}"] for name in CURVES})
        hues, form = arrays["hues"], arrays["form"]
    except (KeyError, ValueError, OSError, EOFError, BadZipFile, zlib.error):
        return None
    counts = (len(standing.centers), len(hues), len(routing.radii))
    items, hyperedges = len(program.items), len(program.hyperedges)
    if form != FORM or counts != (items, hyperedges, hyperedges):
        return None
    placement = place(program, load_notation(program.notation), standing)
    return Layout(program, shown(program, placement), routing, hues)


def _arrays(data: bytes) -> dict[str, np.ndarray[Any, Any]]:
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        return dict(arrays)
