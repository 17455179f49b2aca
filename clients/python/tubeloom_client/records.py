"""What the service says of programs, revisions and jobs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any, Literal, TypeAlias

from tubeloom_client.decoding import decode
from tubeloom_client.events import Event


@dataclass(frozen=True, slots=True)
class Sets:
    """Ids of what an edit added, changed and removed."""

    added: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Changes:
    """What differs from the revision before; ``whole``: anything may look different."""

    items: Sets = field(default_factory=Sets)
    hyperedges: Sets = field(default_factory=Sets)
    whole: bool = False


@dataclass(frozen=True, slots=True)
class Listed:
    """A stored program, as the list of all has it."""

    id: str
    revision: int
    name: str | None
    item_count: int
    hyperedge_count: int
    created_at: datetime
    updated_at: datetime


@dataclass(frozen=True, slots=True)
class Page:
    """A part of that list; ``next`` is what to ask for the part that follows."""

    programs: tuple[Listed, ...]
    next: str | None = None


@dataclass(frozen=True, slots=True)
class Stored:
    """A stored program's document, as JSON values, and the tag of its revision."""

    document: Any
    etag: str


@dataclass(frozen=True, slots=True)
class Revision:
    """One state of a stored program, and what led to it: put, patch, edit, undo or redo.

    ``stopped_by`` is ``"deadline"`` where its layout is the best that there was time for.
    """

    revision: int
    cause: str
    name: str | None
    item_count: int
    hyperedge_count: int
    digest: str
    changes: Changes
    can_undo: bool
    can_redo: bool
    created_at: datetime
    stopped_by: str | None = None


@dataclass(frozen=True, slots=True)
class Changed:
    """What a change has made of a program: its newest revision, and the tag of that."""

    revision: Revision
    etag: str


@dataclass(frozen=True, slots=True)
class Current:
    """Watching begins: the program is at this revision, and whatever comes next will be told."""

    revision: int


@dataclass(frozen=True, slots=True)
class Deleted:
    """The program has been removed, in the revision of this number."""

    revision: int


@dataclass(frozen=True, slots=True)
class Reset:
    """Some revisions are not kept any more: load the program anew, at this revision."""

    revision: int


Happening: TypeAlias = Current | Revision | Deleted | Reset
"""What a watcher of a program hears."""


@dataclass(frozen=True, slots=True)
class JobState:
    """How far a job is; ``share`` goes from 0 to 1, ``problem`` (RFC 9457) says why it failed."""

    id: str
    state: Literal["waiting", "running", "done", "failed", "cancelled"]
    stage: str | None = None
    share: float = 0.0
    attempts: int = 0
    problem: Mapping[str, Any] | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more will happen to it."""
        return self.state in {"done", "failed", "cancelled"}


def happening_of(event: Event) -> Happening | None:
    """What an event of a program tells; None for what this client does not know."""
    match event.name:
        case "current":
            return decode(Current, event.data)
        case "revision":
            return decode(Revision, event.data)
        case "deleted":
            return decode(Deleted, event.data)
        case "reset":
            return decode(Reset, event.data)
        case _:
            return None


def job_after(state: JobState, event: Event) -> JobState:
    """A job's state after an event."""
    match event.name:
        case "progress":
            share, stage = event.data["share"], event.data.get("stage")
            return replace(state, state="running", share=share, stage=stage)
        case "done" | "failed" | "cancelled":
            return decode(JobState, event.data)
        case _:
            return state
