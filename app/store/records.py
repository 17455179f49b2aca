"""What is known of stored programs. Times are milliseconds since 1970."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from app.program.changes import Changes

Cause: TypeAlias = Literal["put", "patch", "edit", "undo", "redo", "delete"]


@dataclass(frozen=True, slots=True)
class Record:
    """What is known of a revision, but for its content.

    ``stopped_by`` says what ended its layout early, if anything did.
    """

    program: str
    number: int
    cause: Cause
    name: str | None
    items: int
    hyperedges: int
    digest: str
    changes: Changes
    undo_to: int | None
    redo_to: int | None
    created_at: int
    stopped_by: str | None = None


@dataclass(frozen=True, slots=True)
class Content:
    """A revision with its document in canonical form, and its layout."""

    record: Record
    document: bytes
    layout: bytes


@dataclass(frozen=True, slots=True)
class Listed:
    """A program in the list of all of them."""

    id: str
    revision: int
    name: str | None
    items: int
    hyperedges: int
    created_at: int
    updated_at: int


@dataclass(frozen=True, slots=True)
class Head:
    """The newest revision's number, and whether the program is deleted."""

    revision: int
    is_deleted: bool
