"""Layouts that are remembered change nothing but how soon the next edit is done."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from app.answers import Edits, Replacement, Revised
from app.layout import Layout, lay_out
from app.program.reading import read_program
from app.recent_layouts import MOST_BYTES, RecentLayouts
from app.revising import revise
from app.settings import Settings

EXAMPLE = (Path(__file__).parents[1] / "examples" / "id3-clause-2.json").read_bytes()
EDITS: list[dict[str, Any]] = [
    {"type": "add_item", "item": {"id": "note", "label": "A note"}},
    {"type": "set_item", "id": "note", "fields": {"position": [9, 9, 0.4]}},
    {"type": "connect", "id": "e.A", "attachments": [{"item": "note"}]},
    {"type": "remove_hyperedge", "id": "e.Es"},
    {"type": "rename_item", "id": "note", "to": "remark"},
    {"type": "remove_item", "id": "remark"},
]


def revisions(monkeypatch: pytest.MonkeyPatch, most: int) -> list[Revised]:
    """All states of the example, by a process that remembers so many."""
    monkeypatch.setattr("app.revising.recent_layouts", RecentLayouts(most))
    made = [revise(b"", None, Replacement(EXAMPLE, "tubeloom"), Settings())]
    for edit in EDITS:
        change = Edits(json.dumps({"edits": [edit]}).encode())
        made.append(revise(made[-1].document, made[-1].layout, change, Settings()))
    return made


def test_what_is_remembered_gives_the_same_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    assert revisions(monkeypatch, 3) == revisions(monkeypatch, 0)


def laid(text: str) -> Layout:
    """A small layout."""
    return lay_out(read_program(text.encode(), Settings()))


def test_the_oldest_goes_and_what_is_kept_cannot_be_changed() -> None:
    recent = RecentLayouts(2)
    layouts = [laid(f'{{"items": [{{"id": "{name}"}}]}}') for name in "abc"]
    for name, layout in zip(b"abc", layouts, strict=True):
        recent.put(bytes([name]), b"layout", layout)
    assert recent.get(b"a", b"layout") is None
    assert recent.get(b"b", b"layout") is layouts[1]
    assert recent.get(b"b", b"another") is None
    assert recent.get(b"b", None) is None
    with pytest.raises(ValueError, match="read-only"):
        layouts[1].placement.centers[0] = 1


def test_what_is_very_large_is_not_kept() -> None:
    recent = RecentLayouts()
    recent.put(b"a", bytes(MOST_BYTES), laid('{"items": [{"id": "a"}]}'))
    assert recent.get(b"a", bytes(MOST_BYTES)) is None
