"""The next revision of a stored program: changed, checked, and laid out so that it keeps still."""

from __future__ import annotations

import hashlib
from dataclasses import replace

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
from app.hyperedges.stopping import Spent, nothing_spent
from app.layout import Layout, Progress, lay_out, silent
from app.layout_changes import changes_between
from app.layout_record import read_layout, write_layout
from app.program.edits import Edited, apply_edits
from app.program.model import Program
from app.program.patching import apply_json_patch, apply_merge_patch
from app.program.reading import read_program
from app.program.renaming import renamed
from app.program.writing import Writer
from app.recent_layouts import recent_layouts
from app.settings import Settings

_writer = Writer()
"""Of this process."""


def revise(
    document: bytes,
    layout: bytes | None,
    change: Change,
    settings: Settings,
    progress: Progress = silent,
    spent: Spent = nothing_spent,
) -> Revised:
    """What ``change`` makes of ``document`` (canonical, or empty if there is none) and its layout.

    Whatever the change does not concern keeps its place, its colour and its curves to the last bit.
    Raises what reading a document raises, and what `app.program.patching` and `app.program.edits`
    do; then nothing has happened. When the time for the layout is ``spent``, it is the best so far.
    """
    progress("reading", 0.0)
    previous = _previous(document, layout, settings, spent)
    before = None if previous is None else previous.program
    if isinstance(change, Restoration):
        revised = _restored(previous, change, settings, spent)
    else:
        edited = _changed(before, document, change, settings)
        known = None
        if before is not None and previous is not None:
            known = replace(previous, program=renamed(before, edited))
        # Who puts a program again whose layout was stopped wants another attempt.
        anew = isinstance(change, Replacement) and known is not None and not known.complete
        laid = lay_out(edited.program, known, progress, spent, curves_anew=anew)
        progress("writing", 0.6)
        written = _writer.write(edited.program)
        revised = _revised(previous, laid, written, write_layout(laid))
        recent_layouts.put(revised.document, revised.layout, laid)
    progress("done", 1.0)
    return revised


def _previous(
    document: bytes, layout: bytes | None, settings: Settings, spent: Spent
) -> Layout | None:
    if not document:
        return None
    if (recent := recent_layouts.get(document, layout)) is not None:
        return recent
    program = read_program(document, settings)
    read = None if layout is None else read_layout(program, layout)
    return read or lay_out(program, spent=spent)


def _restored(
    previous: Layout | None, change: Restoration, settings: Settings, spent: Spent
) -> Revised:
    program = read_program(change.document, settings)
    kept = read_layout(program, change.layout)
    if kept is None:
        laid = lay_out(program, spent=spent)
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
        complete=laid.complete,
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
