"""How much of everything a document has, and whether that is too much."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import JsonValue

from app.errors import DocumentTooLarge, Fault, pointer
from app.program.model import Program
from app.settings import Settings


@dataclass(frozen=True, slots=True)
class Count:
    """How many of each there are."""

    items: int
    hyperedges: int
    attachments: int
    label_characters: int = 0


def count(program: Program) -> Count:
    """How much there is in a program."""
    return Count(
        items=len(program.items),
        hyperedges=len(program.hyperedges),
        attachments=sum(len(hyperedge.attachments) for hyperedge in program.hyperedges),
        label_characters=sum(len(item.label) for item in program.items if item.label),
    )


def count_entries(document: JsonValue) -> Count:
    """How much there seems to be in a document that nobody has validated yet."""
    hyperedges = _entries(document, "hyperedges")
    return Count(
        items=len(_entries(document, "items")),
        hyperedges=len(hyperedges),
        attachments=sum(len(_entries(hyperedge, "attachments")) for hyperedge in hyperedges),
    )


def refuse_too_many(found: Count, settings: Settings) -> None:
    """Raise `DocumentTooLarge` with every limit that is passed."""
    faults = [
        Fault(pointer(place), f"{number} {what} are more than the limit of {most}.")
        for place, number, most, what in (
            ("items", found.items, settings.max_items, "items"),
            ("hyperedges", found.hyperedges, settings.max_hyperedges, "hyperedges"),
            ("hyperedges", found.attachments, settings.max_attachments, "attachments in all"),
            (
                "items",
                found.label_characters,
                settings.max_label_characters,
                "characters in labels",
            ),
        )
        if number > most
    ]
    if faults:
        raise DocumentTooLarge(faults)


def _entries(value: JsonValue, key: str) -> list[JsonValue]:
    entries = value.get(key) if isinstance(value, dict) else None
    return entries if isinstance(entries, list) else []
