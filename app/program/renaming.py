"""A program under other names, so that what was renamed is known for what it was."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from app.program.edits import Edited
from app.program.model import Attachment, Constraint, Hyperedge, Item, Program


def renamed(before: Program, edited: Edited) -> Program:
    """``before``, as if its parts had always been called what they are called after the edits."""
    if not (edited.items or edited.hyperedges):
        return before
    items = _new_names(edited.items, (item.id for item in before.items))
    hyperedges = _new_names(edited.hyperedges, (one.id for one in before.hyperedges))
    return before.model_copy(
        update={
            "items": tuple(_item(item, items) for item in before.items),
            "hyperedges": tuple(_hyperedge(one, items, hyperedges) for one in before.hyperedges),
            "layout": before.layout.model_copy(
                update={
                    "constraints": tuple(
                        _constraint(one, items) for one in before.layout.constraints
                    )
                }
            ),
        }
    )


def _new_names(old: Mapping[str, str], ids: Iterable[str]) -> dict[str, str]:
    """New names by old ones. What had a new name before, and is not renamed itself, loses it."""
    news = {was: now for now, was in old.items()}
    taken = {name for name in ids if name in old and name not in news}
    return news | {name: f"{name}\N{REPLACEMENT CHARACTER}" for name in taken}


def _item(item: Item, names: Mapping[str, str]) -> Item:
    parent = item.parent if item.parent is None else names.get(item.parent, item.parent)
    if item.id not in names and parent == item.parent:
        return item
    return item.model_copy(update={"id": names.get(item.id, item.id), "parent": parent})


def _hyperedge(
    hyperedge: Hyperedge, items: Mapping[str, str], names: Mapping[str, str]
) -> Hyperedge:
    if hyperedge.id not in names and not any(end.item in items for end in hyperedge.attachments):
        return hyperedge
    return hyperedge.model_copy(
        update={
            "id": names.get(hyperedge.id, hyperedge.id),
            "attachments": tuple(_attachment(end, items) for end in hyperedge.attachments),
        }
    )


def _attachment(end: Attachment, names: Mapping[str, str]) -> Attachment:
    return end.model_copy(update={"item": names[end.item]}) if end.item in names else end


def _constraint(constraint: Constraint, names: Mapping[str, str]) -> Constraint:
    items = tuple(names.get(name, name) for name in constraint.items)
    return constraint.model_copy(update={"items": items})
