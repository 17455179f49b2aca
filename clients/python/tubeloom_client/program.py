"""A stored program, for a client that waits for each answer."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Unpack

from tubeloom_client import calls
from tubeloom_client.calls import Call
from tubeloom_client.job import Job
from tubeloom_client.layouts import Layout
from tubeloom_client.options import Document, Format, RenderOptions
from tubeloom_client.problems import LostRace
from tubeloom_client.records import Changed, Deleted, Happening, Revision, happening_of

if TYPE_CHECKING:
    from tubeloom_client.client import Client

TRIES = 20


class Program:
    """The stored program called ``id``.

    ``etag`` is the revision that was last seen here: every change is made only if the program is
    still as it was then, and raises `LostRace` otherwise. None makes changes without condition.
    """

    def __init__(self, client: Client, identifier: str) -> None:
        self._client = client
        self.id = identifier
        self.etag: str | None = None

    def get(self, *, revision: int | None = None) -> Any:
        """The document, as JSON values; of an older ``revision``, if that is still kept."""
        stored = self._client.send(calls.get(self.id, revision))
        if revision is None:
            self.etag = stored.etag
        return stored.document

    def put(self, document: Document, *, source: str | None = None) -> Revision:
        """Store ``document``, in place of what there was."""
        return self._changed(calls.put(self.id, document, source, self.etag, only_new=False))

    def create(self, document: Document, *, source: str | None = None) -> Revision:
        """Store ``document``, unless there is such a program: that raises `LostRace`."""
        return self._changed(calls.put(self.id, document, source, None, only_new=True))

    def edit(self, *edits: Mapping[str, Any]) -> Revision:
        """Carry out edits, all or none; what they do not concern stays where it is."""
        return self._changed(calls.edit(self.id, edits, self.etag, amend=False))

    def amend(self, *edits: Mapping[str, Any]) -> Revision:
        """Carry out edits that are one change to undo with the edits before."""
        return self._changed(calls.edit(self.id, edits, self.etag, amend=True))

    def patch(self, change: Mapping[str, Any] | Sequence[Mapping[str, Any]]) -> Revision:
        """Change the document by a JSON Merge Patch (a mapping) or a JSON Patch (a sequence)."""
        return self._changed(calls.patch(self.id, change, self.etag))

    def update(self, change: Callable[[Any], Document]) -> Revision:
        """Store what ``change`` makes of the document; again, where others change it meanwhile."""
        for _ in range(TRIES - 1):
            try:
                return self.put(change(self.get()))
            except LostRace:
                continue
        return self.put(change(self.get()))

    def undo(self) -> Revision:
        """Take the last change back."""
        return self._changed(calls.step(self.id, "undo", self.etag))

    def redo(self) -> Revision:
        """Make a change again that was taken back."""
        return self._changed(calls.step(self.id, "redo", self.etag))

    def delete(self) -> None:
        """Remove the program."""
        self._client.send(calls.delete(self.id, self.etag))
        self.etag = None

    def revisions(self) -> tuple[Revision, ...]:
        """The revisions that are kept, the newest first."""
        return self._client.send(calls.revisions(self.id))

    def render(
        self,
        *,
        format: Format = "glb",  # noqa: A002 - as the service calls it
        since: int | None = None,
        revision: int | None = None,
        **options: Unpack[RenderOptions],
    ) -> bytes:
        """The scene; with ``since``, as glTF of only what has changed after that revision."""
        return self._client.send(calls.render_stored(self.id, format, since, revision, options))

    def layout(self, *, patches: bool = False, revision: int | None = None) -> Layout:
        """The numbers of the layout."""
        return self._client.send(calls.layout_stored(self.id, patches, revision))

    def start(
        self,
        *,
        format: Format = "png",  # noqa: A002 - as the service calls it
        revision: int | None = None,
        **options: Unpack[RenderOptions],
    ) -> Job:
        """Make a job of a render, and do not wait for it."""
        call = calls.start_stored(self.id, format, revision, options)
        return Job(self._client, self._client.send(call).id)

    def watch(self, *, after: int | None = None) -> Generator[Happening, None, None]:
        """What happens to the program, from now on or from what came after a revision.

        Where nothing is given for ``after``, the first thing told is `Current`: every change from
        then on is told. Goes on by itself where the connection breaks, without missing a revision;
        ends when the program is deleted.
        """
        last = None if after is None else str(after)
        for event in self._client.events(calls.watched(self.id), last):
            happening = happening_of(event)
            if happening is not None:
                yield happening
            if isinstance(happening, Deleted):
                return

    def _changed(self, call: Call[Changed]) -> Revision:
        changed = self._client.send(call)
        self.etag = changed.etag
        return changed.revision
