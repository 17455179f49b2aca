"""The next revision of a stored program: changed, checked, and laid out so that it keeps still."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.answers import (
    Change,
    Edits,
    JsonPatch,
    MergePatch,
    Replacement,
    Restoration,
    Revised,
)
from app.formats import registry
from app.layout import Layout, Progress, lay_out, silent
from app.layout_record import read_layout, write_layout
from app.program.changes import Changes, Differences
from app.program.digest import canonical
from app.program.edits import Edited, apply_edits
from app.program.model import Program
from app.program.patching import apply_json_patch, apply_merge_patch
from app.program.reading import read_program
from app.program.renaming import renamed
from app.recent_layouts import recent_layouts
from app.settings import Settings


def revise(
    document: bytes,
    layout: bytes | None,
    change: Change,
    settings: Settings,
    progress: Progress = silent,
) -> Revised:
    """What ``change`` makes of ``document`` (canonical, or empty if there is none) and its layout.

    Whatever the change does not concern keeps its place, its colour and its curves to the last bit.
    Raises what reading a document raises, and what `app.program.patching` and `app.program.edits`
    do; then nothing has happened.
    """
    progress("reading", 0.0)
    previous = _previous(document, layout, settings)
    before = None if previous is None else previous.program
    if isinstance(change, Restoration):
        revised = _restored(previous, change, settings)
    else:
        edited = _changed(before, document, change, settings)
        known = None
        if before is not None and previous is not None:
            known = replace(previous, program=renamed(before, edited))
        laid = lay_out(edited.program, known, progress)
        progress("writing", 0.6)
        revised = _revised(previous, laid, canonical(edited.program), write_layout(laid))
        recent_layouts.put(revised.document, revised.layout, laid)
    progress("done", 1.0)
    return revised


def _previous(document: bytes, layout: bytes | None, settings: Settings) -> Layout | None:
    if not document:
        return None
    if (recent := recent_layouts.get(document, layout)) is not None:
        return recent
    program = read_program(document, settings)
    read = None if layout is None else read_layout(program, layout)
    return read or lay_out(program)


def _restored(previous: Layout | None, change: Restoration, settings: Settings) -> Revised:
    program = read_program(change.document, settings)
    kept = read_layout(program, change.layout)
    if kept is None:
        laid = lay_out(program)
        return _revised(previous, laid, change.document, write_layout(laid))
    return _revised(previous, kept, change.document, change.layout)


def _revised(previous: Layout | None, laid: Layout, document: bytes, layout: bytes) -> Revised:
    program = laid.program
    return Revised(
        document,
        layout,
        digest=hashlib.sha256(document + layout).hexdigest(),
        name=program.name,
        items=len(program.items),
        hyperedges=len(program.hyperedges),
        changes=changes_between(previous, laid),
    )


def changes_between(before: Layout | None, after: Layout) -> Changes:
    """What looks, stands or runs otherwise in ``after`` than in ``before``, if there was one."""
    if before is None:
        return Changes(
            Differences(added=tuple(_items(after))), Differences(added=tuple(_hyperedges(after)))
        )
    return Changes(
        _differences(_items(before), _items(after)),
        _differences(_hyperedges(before), _hyperedges(after)),
        whole=_frame(before.program) != _frame(after.program),
    )


def _changed(before: Program | None, document: bytes, change: Change, settings: Settings) -> Edited:
    match change:
        case Replacement(data, source):
            return Edited(registry.read(source, data, settings))
        case JsonPatch(data):
            return Edited(apply_json_patch(document, data, settings))
        case MergePatch(data):
            return Edited(apply_merge_patch(document, data, settings))
        case Edits(data):
            if before is None:
                raise ValueError("Edits need a program.")
            return apply_edits(before, data, settings)
        case Restoration():
            raise ValueError("A restoration says already what comes of it.")


def _frame(program: Program) -> Program:
    """All of a program but its items and hyperedges, and what tells only where these stand."""
    layout = program.layout.model_copy(update={"constraints": ()})
    return program.model_copy(update={"items": (), "hyperedges": (), "layout": layout})


def _items(layout: Layout) -> Mapping[str, object]:
    """For each item what it says, and where and how large it is, to the bit."""
    placement = layout.placement
    rows = np.concatenate([placement.centers, placement.rotations, placement.sizes], axis=1)
    return {
        item.id: (item, row.tobytes()) for item, row in zip(layout.program.items, rows, strict=True)
    }


def _hyperedges(layout: Layout) -> Mapping[str, object]:
    """For each hyperedge what it says, its colour, its thickness and its curves, to the bit."""
    routing = layout.routing
    starts = routing.segment_starts.tolist()
    return {
        hyperedge.id: (hyperedge, hue, radius, routing.control_points[begin:end].tobytes())
        for hyperedge, hue, radius, begin, end in zip(
            layout.program.hyperedges,
            layout.hues.tolist(),
            routing.radii.tolist(),
            starts[:-1],
            starts[1:],
            strict=True,
        )
    }


def _differences(before: Mapping[str, object], after: Mapping[str, object]) -> Differences:
    return Differences(
        added=tuple(name for name in after if name not in before),
        changed=tuple(name for name in after if name in before and before[name] != after[name]),
        removed=tuple(name for name in before if name not in after),
    )
