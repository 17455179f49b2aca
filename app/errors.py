"""What can go wrong in Tubeloom itself. Nothing here knows of HTTP.

::

    TubeloomError
    ├── DocumentError               the document is wrong; carries every fault found
    │   ├── UnreadableDocument      it is not JSON at all
    │   ├── InvalidDocument         it is JSON, but does not follow the schema
    │   ├── InconsistentDocument    it follows the schema, but contradicts itself
    │   │   └── ImpossibleSweep     what is to be varied is not in it, or not by such values
    │   ├── PatchConflict           a patch does not fit what there is
    │   ├── DocumentTooLarge        it has more of something than the limits allow
    │   └── Unprintable             something in it has no closed body
    ├── UnknownName                 a format, notation, palette or material that does not exist
    ├── PictureTooLarge             more pixels than the limits allow
    ├── OutOfMemory                 the work takes more memory than it may
    ├── RendererUnavailable         no way to draw on this machine; says what to install
    ├── WorkerLost                  a worker process died twice over the same work
    ├── DeadlineExceeded            the work took longer than it may
    ├── Overloaded                  too much work is waiting already
    ├── NotStored                   no such program, revision, job or result is stored
    ├── StoreFull                   no more programs are taken
    ├── Outdated                    somebody else changed a stored program first
    ├── NothingToUndo               there is no change to take back, or to make again
    └── StoreUnavailable            the database or the object store does not answer
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import takewhile

LONGEST_KEY = 300
"""Of those that pointers lead to; whoever sends a key of megabytes does not get it back."""


def pointer(*parts: str | int) -> str:
    """JSON pointer (RFC 6901) to the place that ``parts`` lead to, or to what holds a huge key.

    >>> pointer("items", 3, "a/b"), pointer("items", 3, "a" * 1_000)
    ('/items/3/a~1b', '/items/3')
    """
    way = takewhile(lambda part: len(part) <= LONGEST_KEY, map(str, parts))
    return "".join("/" + part.replace("~", "~0").replace("/", "~1") for part in way)


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing wrong with a document: where (JSON pointer), and what would be right."""

    pointer: str
    detail: str


class TubeloomError(Exception):
    """Root of everything that Tubeloom raises on purpose."""


class DocumentError(TubeloomError):
    """The document cannot be used. ``faults`` holds every fault found, not only the first."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = tuple(faults)
        super().__init__(
            "; ".join(f"{fault.pointer or '/'}: {fault.detail}" for fault in self.faults)
        )

    def __reduce__(self) -> tuple[type[DocumentError], tuple[tuple[Fault, ...]]]:
        return type(self), (self.faults,)


class UnreadableDocument(DocumentError):
    """The bytes are not a JSON document."""


class InvalidDocument(DocumentError):
    """The document does not follow its schema."""


class InconsistentDocument(DocumentError):
    """The document follows its schema, but its parts contradict each other."""


class ImpossibleSweep(InconsistentDocument):
    """The document has no such variations as are asked for."""


class PatchConflict(DocumentError):
    """A patch tests for, or changes, what is not there."""


class DocumentTooLarge(DocumentError):
    """The document exceeds a limit of this service."""


class Unprintable(DocumentError):
    """Something in the document has no closed body that could be printed."""


class UnknownName(TubeloomError):
    """There is no ``kind`` (format, notation, …) of that name."""

    def __init__(self, kind: str, name: str, known: Sequence[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        super().__init__(f"There is no {kind} {name!r}; known are {', '.join(self.known)}.")

    def __reduce__(self) -> tuple[type[UnknownName], tuple[str, str, tuple[str, ...]]]:
        return type(self), (self.kind, self.name, self.known)


class PictureTooLarge(TubeloomError):
    """More pixels are asked for than this service draws."""


class OutOfMemory(TubeloomError):
    """The work takes more memory than a worker may; the message says what would do."""


class RendererUnavailable(TubeloomError):
    """This machine lacks what the renderer needs; the message says how to install it."""


class WorkerLost(TubeloomError):
    """The process that did the work died, and so did the one that tried again."""


class DeadlineExceeded(TubeloomError):
    """The work was stopped because it took too long."""


class Overloaded(TubeloomError):
    """The service has more work waiting than it accepts."""


class NotStored(TubeloomError):
    """There is no such program, revision, job or result (any more)."""


class StoreFull(TubeloomError):
    """As many programs are stored as this service takes."""


class Outdated(TubeloomError):
    """Somebody else changed a stored program first."""


class NothingToUndo(TubeloomError):
    """There is no change that could be taken back, or made again."""


class StoreUnavailable(TubeloomError):
    """The database or the object store does not answer; what was asked may or may not be done."""
