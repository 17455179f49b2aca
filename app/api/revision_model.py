"""Revisions of stored programs as answers and events tell of them."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Literal, Self

from pydantic import BaseModel, Field

from app.program.changes import Changes, Differences
from app.store.records import Listed, Record


class Differing(BaseModel):
    """Ids of one kind of things; no id is in two of the lists."""

    added: tuple[str, ...]
    changed: tuple[str, ...] = Field(description="Said, placed, coloured or curved otherwise.")
    removed: tuple[str, ...]

    @classmethod
    def of(cls, differences: Differences) -> Self:
        """The same as it is told."""
        return cls(
            added=differences.added, changed=differences.changed, removed=differences.removed
        )


class ChangesModel(BaseModel):
    """What differs from the revision before."""

    items: Differing
    hyperedges: Differing
    whole: bool = Field(
        description="Whether all must be shown anew, such as after a change of style or view."
    )

    @classmethod
    def of(cls, changes: Changes) -> Self:
        """The same as it is told."""
        return cls(
            items=Differing.of(changes.items),
            hyperedges=Differing.of(changes.hyperedges),
            whole=changes.whole,
        )


class RevisionModel(BaseModel):
    """One state of a stored program, and what led to it."""

    program: str
    revision: int = Field(description="One more than of the revision before.")
    cause: str = Field(description="put, patch, edit, undo, redo or delete.")
    name: str | None
    item_count: int
    hyperedge_count: int
    digest: str = Field(description="SHA-256 of the document and its layout.")
    changes: ChangesModel
    can_undo: bool
    can_redo: bool
    created_at: datetime
    stopped_by: Literal["deadline"] | None = Field(
        None,
        description="`deadline` where there was not time enough for the layout, which is the best "
        "so far.",
    )

    @classmethod
    def of(cls, record: Record) -> Self:
        """A revision as it is told."""
        return cls(
            program=record.program,
            revision=record.number,
            cause=record.cause,
            name=record.name,
            item_count=record.items,
            hyperedge_count=record.hyperedges,
            digest=record.digest,
            changes=ChangesModel.of(record.changes),
            can_undo=record.undo_to is not None,
            can_redo=record.redo_to is not None,
            created_at=moment(record.created_at),
            stopped_by="deadline" if record.stopped_by == "deadline" else None,
        )


class RevisionList(BaseModel):
    """The revisions that are kept."""

    revisions: tuple[RevisionModel, ...] = Field(description="The newest first.")


class ListedModel(BaseModel):
    """A stored program in the list of all of them."""

    id: str
    revision: int
    name: str | None
    item_count: int
    hyperedge_count: int
    created_at: datetime
    updated_at: datetime

    @classmethod
    def of(cls, listed: Listed) -> Self:
        """A program as it is told."""
        return cls(
            id=listed.id,
            revision=listed.revision,
            name=listed.name,
            item_count=listed.items,
            hyperedge_count=listed.hyperedges,
            created_at=moment(listed.created_at),
            updated_at=moment(listed.updated_at),
        )


class ProgramList(BaseModel):
    """Some of the stored programs, in the order of their ids."""

    programs: tuple[ListedModel, ...]
    next: str | None = Field(description="What to ask for `after`; null: there are no more.")


def moment(milliseconds: int) -> datetime:
    """A time in milliseconds since 1970.

    >>> moment(0).isoformat()
    '1970-01-01T00:00:00+00:00'
    """
    return datetime.fromtimestamp(milliseconds / 1000, UTC)


def tag_of(record: Record) -> str:
    """A validator of a revision's document: its number, and a digest besides."""
    return f"{record.number}-{record.digest[:16]}"
