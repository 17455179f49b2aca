"""Layouts as bytes, so that a stored program looks after a restart as it did before, to the bit.

What can be computed again from the program (solids, labels) is not in them.
"""

from __future__ import annotations

import io
import zlib
from dataclasses import replace
from typing import Any, get_args
from zipfile import BadZipFile

import numpy as np

from app.hyperedges.routing import Routing
from app.layout import Layout, shown
from app.notations.loader import load_notation
from app.placement.modes import Mode
from app.placement.place import place
from app.placement.standing import Standing
from app.program.model import Program

FORM = 2
"""Of the bytes; another form cannot be read, and the program is laid out anew."""

PLACES = ("centers", "rotations", "sizes", "offsets", "turns")
MODES: dict[str, Mode] = {mode: mode for mode in get_args(Mode)}
ENDS = ("attachment_positions", "attachment_directions")
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
    arrays = {name: getattr(layout.placement, name) for name in PLACES + ENDS}
    arrays |= {f"routing_{name}": getattr(layout.routing, name) for name in CURVES}
    arrays["placement_mode"] = np.array(layout.placement.mode)
    arrays["is_elastic"] = np.array(layout.routing.is_elastic)
    if not layout.complete:
        arrays["stopped"] = np.array(True)
    np.savez(file, form=FORM, hues=layout.hues, **arrays)
    return file.getvalue()


def read_layout(program: Program, data: bytes) -> Layout | None:
    """The layout that was written, or ``None`` where another version wrote it, or it is broken."""
    try:
        arrays = _arrays(data)
        mode = MODES[str(arrays.get("placement_mode", "rows"))]
        standing = Standing(program, *(arrays[name] for name in PLACES), mode=mode)
        curves: dict[str, Any] = {name: arrays[f"routing_{name}"] for name in CURVES}
        routing = Routing(**curves, is_elastic=bool(arrays.get("is_elastic", False)))
        hues, form = arrays["hues"], arrays["form"]
        positions, directions = (arrays[name] for name in ENDS)
    except (KeyError, ValueError, OSError, EOFError, BadZipFile, zlib.error):
        return None
    counts = (len(standing.centers), len(hues), len(routing.radii))
    items, hyperedges = len(program.items), len(program.hyperedges)
    if form != FORM or counts != (items, hyperedges, hyperedges):
        return None
    placement = place(program, load_notation(program.notation), standing)
    if len(positions) != len(placement.attachment_items):
        return None
    placed = replace(
        shown(program, placement),
        attachment_positions=positions,
        attachment_directions=directions,
    )
    return Layout(program, placed, routing, hues, complete="stopped" not in arrays)


def _arrays(data: bytes) -> dict[str, np.ndarray[Any, Any]]:
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        return dict(arrays)
