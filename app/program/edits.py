"""Edits by what they mean: each checks itself, and leaves everything else as it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

from pydantic import JsonValue

from app.errors import DocumentError, DocumentTooLarge, Fault, InconsistentDocument, pointer
from app.program.base import Part
from app.program.checking import check
from app.program.csg import refuse_large_trees
from app.program.edit_checks import (
    WrongEdit,
    all_said,
    let_go,
    must_be_attachable,
    must_be_free,
    must_be_joined,
    must_be_known,
    said,
)
from app.program.edit_model import (
    AddHyperedge,
    AddItem,
    Connect,
    Disconnect,
    EditList,
    Fields,
    Group,
    Merge,
    RemoveHyperedge,
    RemoveItem,
    RenameHyperedge,
    RenameItem,
    Reparent,
    SetHyperedge,
    SetItem,
    SetProgram,
    Split,
    Ungroup,
)
from app.program.editable import Editable
from app.program.grouping import group, ungroup
from app.program.hints import Hints
from app.program.merging import merged
from app.program.model import Hyperedge, Item, Program
from app.program.parsing import parse
from app.program.reading import validate
from app.program.shapes import Csg, Tray
from app.settings import Settings

AnyPart = TypeVar("AnyPart", bound=Part)

_ITEMS = ("item", "tray", "fields")
"""Where in an edit an item may stand, or fields of one."""


@dataclass(frozen=True, slots=True)
class Edited:
    """A program after edits, and the names before of what was renamed, by the names after."""

    program: Program
    items: Mapping[str, str] = field(default_factory=dict)
    hyperedges: Mapping[str, str] = field(default_factory=dict)


def apply_edits(before: Program, data: bytes, settings: Settings) -> Edited:
    """The program that the JSON document ``data`` (an `EditList`) makes of ``before``.

    Raises `UnreadableDocument`, `InvalidDocument`, `DocumentTooLarge`, and `InconsistentDocument`
    where an edit does not fit the program that those before it have made: all or none are done.
    """
    document = parse(data, settings)
    _refuse_large_trees(document, settings)
    edits = validate(EditList, document).edits
    program = Editable(before)
    hints = Hints()
    for number, edit in enumerate(edits):
        try:
            _DO[type(edit)](program, edit, hints)
        except WrongEdit as error:
            where = pointer("edits", number, *error.place)
            raise InconsistentDocument([Fault(where, error.detail)]) from None
        except DocumentError as error:
            within = pointer("edits", number, "fields")
            raise type(error)(
                Fault(within + fault.pointer, fault.detail) for fault in error.faults
            ) from None
    after = program.freeze()
    _check(before, after, settings)
    return Edited(after, program.names, program.hyperedge_names)


def _refuse_large_trees(document: JsonValue, settings: Settings) -> None:
    """Refuse trees of solids that nobody should validate."""
    edits = document.get("edits") if isinstance(document, dict) else None
    for number, edit in enumerate(edits if isinstance(edits, list) else ()):
        parts = [edit.get(key) for key in _ITEMS] if isinstance(edit, dict) else []
        try:
            refuse_large_trees({"items": parts}, settings)
        except DocumentTooLarge as error:
            raise DocumentTooLarge(
                Fault(pointer("edits", number), fault.detail) for fault in error.faults
            ) from None


def _check(before: Program, program: Program, settings: Settings) -> None:
    trees: list[JsonValue] = [
        {"shape": item.shape.model_dump(mode="json")}
        for item in program.items
        if isinstance(item.shape, Csg)
    ]
    try:
        refuse_large_trees({"items": trees}, settings)
        check(program, settings, before)
    except DocumentError as error:
        raise type(error)(
            Fault("/edits", f"After these edits, {fault.pointer or 'the program'}: {fault.detail}")
            for fault in error.faults
        ) from None


def _add_item(program: Editable, edit: AddItem, hints: Hints) -> None:
    must_be_free(edit.item.id, program.items, "item", "item", "id")
    if edit.item.parent is not None:
        must_be_known(edit.item.parent, program.items, hints, "item", "parent")
    program.put_item(edit.item)


def _remove_item(program: Editable, edit: RemoveItem, hints: Hints) -> None:
    must_be_known(edit.id, program.items, hints, "id")
    program.remove_items(tuple(program.within(edit.id)))


def _rename_item(program: Editable, edit: RenameItem, hints: Hints) -> None:
    must_be_known(edit.id, program.items, hints, "id")
    if edit.to != edit.id:
        must_be_free(edit.to, program.items, "item", "to")
        program.rename_item(edit.id, edit.to)


def _set_item(program: Editable, edit: SetItem, hints: Hints) -> None:
    must_be_known(edit.id, program.items, hints, "id")
    _refuse_fields(edit.fields, {"id": "rename_item", "parent": "reparent"})
    before = program.items[edit.id]
    shape, now = before.shape, edit.fields.get("shape")
    if shape is not None and isinstance(now, dict) and now.get("type", shape.type) != shape.type:
        # Sizes of the old shape say nothing of one of another type.
        before = before.model_copy(update={"shape": None})
    item = _with_fields(Item, before, edit.fields)
    if "position" in edit.fields and item.position is not None:
        program.leave_line_ups(edit.id)
    program.put_item(item)


def _reparent(program: Editable, edit: Reparent, hints: Hints) -> None:
    must_be_known(edit.id, program.items, hints, "id")
    if edit.parent is not None:
        must_be_known(edit.parent, program.items, hints, "parent")
        if edit.parent in program.within(edit.id):
            raise WrongEdit(("parent",), "An item cannot be contained in itself.")
    item = program.items[edit.id]
    if item.parent != edit.parent:
        program.leave_line_ups(edit.id)
        # A position is relative to the parent: the old one says nothing in the new one.
        program.put_item(item.model_copy(update={"parent": edit.parent, "position": None}))


def _group(program: Editable, edit: Group, hints: Hints) -> None:
    for place, name in enumerate(edit.items):
        must_be_known(name, program.items, hints, "items", place)
        if program.items[name].parent != program.items[edit.items[0]].parent:
            raise WrongEdit(("items", place), "Items to group must have the same parent.")
    if len(set(edit.items)) < len(edit.items):
        raise WrongEdit(("items",), "No item can be grouped twice.")
    must_be_free(edit.tray.id, program.items, "item", "tray", "id")
    parent = program.items[edit.items[0]].parent
    if edit.tray.parent not in {None, parent}:
        raise WrongEdit(("tray", "parent"), "The new item gets the parent that the items had.")
    shape = edit.tray.shape or (None if edit.tray.kind else Tray(type="tray"))
    group(program, edit.items, edit.tray.model_copy(update={"parent": parent, "shape": shape}))


def _ungroup(program: Editable, edit: Ungroup, hints: Hints) -> None:
    must_be_known(edit.id, program.items, hints, "id")
    ungroup(program, edit.id)


def _add_hyperedge(program: Editable, edit: AddHyperedge, hints: Hints) -> None:
    must_be_free(edit.hyperedge.id, program.hyperedges, "hyperedge", "hyperedge", "id")
    must_be_attachable(program, edit.hyperedge.attachments, hints, "hyperedge", "attachments")
    program.put_hyperedge(edit.hyperedge)


def _remove_hyperedge(program: Editable, edit: RemoveHyperedge, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    program.remove_hyperedge(edit.id)


def _rename_hyperedge(program: Editable, edit: RenameHyperedge, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    if edit.to != edit.id:
        must_be_free(edit.to, program.hyperedges, "hyperedge", "to")
        program.rename_hyperedge(edit.id, edit.to)


def _set_hyperedge(program: Editable, edit: SetHyperedge, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    _refuse_fields(edit.fields, {"id": "rename_hyperedge", "attachments": "connect and disconnect"})
    before = program.hyperedges[edit.id]
    program.put_hyperedge(_with_fields(Hyperedge, before, edit.fields))


def _connect(program: Editable, edit: Connect, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    must_be_attachable(program, edit.attachments, hints, "attachments")
    joined = program.hyperedges[edit.id].attachments
    present = all_said(joined)
    for place, end in enumerate(edit.attachments):
        if said(end) in present:
            raise WrongEdit(
                ("attachments", place), "This hyperedge has the same attachment already."
            )
    program.put_attachments(edit.id, (*joined, *edit.attachments))


def _disconnect(program: Editable, edit: Disconnect, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    let_go(program, edit.id, edit.attachments, "attachments")


def _merge(program: Editable, edit: Merge, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    must_be_known(edit.other, program.hyperedges, hints, "other", what="hyperedge")
    if edit.id == edit.other:
        raise WrongEdit(("other",), "A hyperedge cannot be merged with itself.")
    joined = program.hyperedges[edit.id].attachments
    present = all_said(joined)
    others = program.hyperedges[edit.other].attachments
    program.remove_hyperedge(edit.other)
    program.put_attachments(
        edit.id, (*joined, *(end for end in others if said(end) not in present))
    )


def _split(program: Editable, edit: Split, hints: Hints) -> None:
    must_be_known(edit.id, program.hyperedges, hints, "id", what="hyperedge")
    must_be_free(edit.into, program.hyperedges, "hyperedge", "into")
    whole = program.hyperedges[edit.id]
    moving = all_said(edit.attachments)
    for place, end in enumerate(edit.shared):
        if said(end) not in moving:
            raise WrongEdit(("shared", place), "Only attachments of the new hyperedge are shared.")
    shared = all_said(edit.shared)
    leaving = tuple(end for end in edit.attachments if said(end) not in shared)
    must_be_joined(whole, edit.attachments, "attachments")
    let_go(program, edit.id, leaving, "attachments")
    program.put_hyperedge(
        whole.model_copy(update={"id": edit.into, "attachments": edit.attachments})
    )


def _set_program(program: Editable, edit: SetProgram, _hints: Hints) -> None:
    _refuse_fields(
        edit.fields, {"items": "the edits of items", "hyperedges": "the edits of hyperedges"}
    )
    frame = program.freeze().model_copy(update={"items": (), "hyperedges": ()})
    program.set_program(_with_fields(Program, frame, edit.fields))


_DO: Mapping[type[Part], Callable[[Editable, Any, Hints], None]] = {
    AddItem: _add_item,
    RemoveItem: _remove_item,
    RenameItem: _rename_item,
    SetItem: _set_item,
    Reparent: _reparent,
    Group: _group,
    Ungroup: _ungroup,
    AddHyperedge: _add_hyperedge,
    RemoveHyperedge: _remove_hyperedge,
    RenameHyperedge: _rename_hyperedge,
    SetHyperedge: _set_hyperedge,
    Connect: _connect,
    Disconnect: _disconnect,
    Merge: _merge,
    Split: _split,
    SetProgram: _set_program,
}


def _refuse_fields(fields: Fields, instead: Mapping[str, str]) -> None:
    for name, edit in instead.items():
        if name in fields:
            raise WrongEdit(("fields", name), f"This is changed by {edit}.")


def _with_fields(model: type[AnyPart], part: AnyPart, fields: Fields) -> AnyPart:
    """The part with other fields. Raises `InvalidDocument` with pointers into the part."""
    document: JsonValue = part.model_dump(mode="json", exclude_defaults=True)
    return validate(model, merged(document, fields))
