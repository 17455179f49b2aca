"""What the service asks of a worker, and what a worker replies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from app.answers import Answer, Options, Revised, Unchanged
from app.errors import OutOfMemory, TubeloomError

SOON_OVER = 0.001
"""Seconds that a work has whose time is over already."""


@dataclass(frozen=True, slots=True)
class Work:
    """One call of the pipeline; the document follows as raw bytes.

    ``reports`` asks for a `Report` now and then before the reply. ``layout`` is a stored program's;
    ``shared`` is that of a posted document, which an earlier answer has left. It may take so many
    ``seconds`` from when it comes; None where nobody counts them.
    """

    options: Options
    known: frozenset[str] = frozenset()
    reports: bool = False
    layout: bytes | None = None
    shared: bytes | None = None
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Report:
    """How far a work is: what is being done, and the share of the whole that is done, 0 to 1.

    A preview of the picture, as PNG, may follow as raw bytes.
    """

    stage: str
    share: float


@dataclass(frozen=True, slots=True)
class Crash:
    """An error that nobody foresaw, as its traceback."""

    traceback: str


Outcome: TypeAlias = Answer | Unchanged | Revised | TubeloomError | Crash


@dataclass(frozen=True, slots=True)
class Stage:
    """A part of the work, and how many seconds it took."""

    name: str
    seconds: float


@dataclass(frozen=True, slots=True)
class Reply:
    """What became of a work. An answer's body follows as raw bytes.

    A worker that ``is_spent`` is in no state for another work: it ran out of memory, or holds more
    than it should between works. ``shared`` is the layout that it made, for other answers.
    """

    outcome: Outcome
    stages: tuple[Stage, ...] = ()
    is_spent: bool = False
    shared: bytes | None = None

    @property
    def ran_out(self) -> bool:
        """Whether memory ran out at work; a worker that has done nothing yet may have enough."""
        return self.is_spent and isinstance(self.outcome, OutOfMemory)


@dataclass(frozen=True, slots=True)
class Ready:
    """A worker is warm. ``draft_problem`` says what it lacks to draw drafts, if anything."""

    draft_problem: str | None
