"""The client that waits for each answer."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from types import TracebackType
from typing import Any, Literal, Self, TypeVar, Unpack

import httpx

from tubeloom_client import calls
from tubeloom_client.calls import Call
from tubeloom_client.events import Event, EventReader
from tubeloom_client.job import Job
from tubeloom_client.layouts import Layout
from tubeloom_client.options import Document, Format, RenderOptions
from tubeloom_client.patience import Patience
from tubeloom_client.problems import Busy, JobCancelled, Problem, Unreachable, problem_of
from tubeloom_client.program import Program
from tubeloom_client.records import JobState, Listed

Answer = TypeVar("Answer")

URL = "http://127.0.0.1:8000"
TIMEOUT_SECONDS = 120.0


class Client:
    """A client of the service at ``url``, with an API ``key`` where the service wants one.

    ``timeout``: seconds that one answer may take. ``patience``: seconds to try again where nobody
    answers, or where the service is busy and says so. Threads may share a client.
    """

    def __init__(
        self,
        url: str = URL,
        *,
        key: str | None = None,
        timeout: float = TIMEOUT_SECONDS,
        patience: float = 30.0,
    ) -> None:
        headers = {} if key is None else {"Authorization": f"Bearer {key}"}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout)
        self._patience = patience

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def render(
        self,
        document: Document,
        *,
        format: Format = "glb",  # noqa: A002 - as the service calls it
        source: str | None = None,
        **options: Unpack[RenderOptions],
    ) -> bytes:
        """The scene of ``document`` (in the format ``source``) as a file of ``format``."""
        return self.send(calls.render(document, source, format, options))

    def layout(
        self, document: Document, *, source: str | None = None, patches: bool = False
    ) -> Layout:
        """The numbers: where items stand, and the control points of every hyperedge's curves."""
        return self.send(calls.layout(document, source, patches))

    def convert(
        self, document: Document, *, source: str | None = None, to: str = "tubeloom"
    ) -> Any:
        """``document`` in another format, as JSON values."""
        return self.send(calls.convert(document, source, to))

    def catalogue(self, name: Literal["notations", "materials", "palettes", "formats"]) -> Any:
        """What there is, as JSON values."""
        return self.send(calls.catalogue(name))

    def program(self, identifier: str) -> Program:
        """The stored program of this name, which need not exist yet. Nothing is sent."""
        return Program(self, identifier)

    def programs(self) -> Iterator[Listed]:
        """All stored programs, by name."""
        after: str | None = None
        while True:
            page = self.send(calls.programs(after))
            yield from page.programs
            if page.next is None:
                return
            after = page.next

    def job(self, identifier: str) -> Job:
        """The job of this name. Nothing is sent."""
        return Job(self, identifier)

    def start(
        self,
        document: Document,
        *,
        format: Format = "png",  # noqa: A002 - as the service calls it
        source: str | None = None,
        **options: Unpack[RenderOptions],
    ) -> Job:
        """Make a job of a render, and do not wait for it."""
        return Job(self, self.send(calls.start(document, source, format, options)).id)

    def run(
        self,
        document: Document,
        *,
        format: Format = "png",  # noqa: A002 - as the service calls it
        source: str | None = None,
        progress: Callable[[JobState], None] | None = None,
        **options: Unpack[RenderOptions],
    ) -> bytes:
        """Make a job of a render, and wait for what it makes.

        ``progress`` hears how it goes on. Whatever ends the waiting early (an exception of
        ``progress``, say, or the keyboard) cancels the job. Raises `JobFailed` or `JobCancelled`.
        """
        job = self.start(document, format=format, source=source, **options)
        try:
            return job.wait(progress)
        except (JobCancelled, Problem):
            raise
        except BaseException:
            with suppress(Problem, Unreachable):
                job.cancel()
            raise

    def send(self, call: Call[Answer]) -> Answer:
        """The answer to ``call``. Raises `Problem` or `Unreachable`."""
        patience = Patience(self._patience)
        while True:
            try:
                return call.answer(self._http.send(call.request(self._http)))
            except httpx.ReadTimeout as error:  # the next would take as long
                raise Unreachable("The answer takes longer than the timeout.") from error
            except (Busy, httpx.TransportError) as error:
                time.sleep(patience.pause_after(error))

    def events(self, path: str, after: str | None = None) -> Iterator[Event]:
        """Server-sent events, those after the one with the id ``after``; goes on by itself.

        Has no end of its own. Raises `Problem` or `Unreachable`.
        """
        patience, reader = Patience(self._patience), EventReader(after)
        while True:
            try:
                with self._http.stream("GET", path, **reader.opening()) as response:
                    if response.is_error:
                        response.read()
                        raise problem_of(response)
                    for piece in response.iter_bytes():
                        patience.take_heart()
                        for event in reader.feed(piece):
                            patience.restore()
                            yield event
                raise httpx.RemoteProtocolError("The stream of events has ended.")
            except (Busy, httpx.TransportError) as error:
                reader.interrupted()
                time.sleep(patience.pause_after(error))
