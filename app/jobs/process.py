"""One worker process, as the service sees it."""

from __future__ import annotations

import asyncio
import subprocess
from collections.abc import Callable

from app.jobs import channel
from app.jobs.launch import Launched, launch
from app.jobs.work import Crash, Ready, Reply, Report, Work
from app.settings import Settings

Listener = Callable[[Report, bytes], None]
"""Told how a work goes on; with a preview, or with no bytes."""


class WorkerDiedError(Exception):
    """The process ended before it replied."""


class WorkerProcess:
    """A process that answers one work at a time."""

    def __init__(
        self,
        process: subprocess.Popen[bytes],
        reader: asyncio.StreamReader,
        writer: asyncio.StreamWriter,
    ) -> None:
        self._process, self._reader, self._writer = process, reader, writer
        loop = asyncio.get_running_loop()
        self._expected: asyncio.Future[tuple[object, tuple[bytes, ...]]] | None = None
        self._listener: Listener | None = None
        self.works = 0
        """How many works it was handed."""
        self.died: asyncio.Future[None] = loop.create_future()
        self._listening = loop.create_task(self._listen())

    @classmethod
    async def start(cls, launched: Launched | None = None) -> WorkerProcess:
        """Start a process, or take one that has been. It imports what it needs, then waits."""
        launched = launched or launch()
        launched.end.setblocking(False)
        reader, writer = await asyncio.open_unix_connection(sock=launched.end, limit=1 << 22)
        return cls(launched.process, reader, writer)

    @property
    def pid(self) -> int:
        """The process's number."""
        return self._process.pid

    async def ready(self, settings: Settings) -> Ready | Crash:
        """Wait until it is warm, or has failed to become so. Raises `WorkerDiedError`.

        Before that it may not be asked.
        """
        first = self._next()
        channel.post(self._writer, settings)
        head, _ = await first
        if not isinstance(head, Ready | Crash):
            raise TypeError(f"A worker began with {type(head).__name__}.")
        return head

    def ask(
        self, work: Work, document: bytes, listener: Listener | None = None
    ) -> asyncio.Future[tuple[Reply, tuple[bytes, ...]]]:
        """Hand it a work. The future raises `WorkerDiedError` when it dies over it.

        The ``listener`` hears the reports that the work asks for.
        """
        reply = self._next()
        self.works += 1
        self._listener = listener
        channel.post(self._writer, work, document)
        return reply

    def kill(self) -> None:
        """End it at once, whatever it is doing; `died` tells when it is gone."""
        self._process.kill()

    async def end(self) -> None:
        """End it, and wait until it is gone."""
        self._process.kill()
        await self._listening

    def _next(self) -> asyncio.Future[tuple[Reply, tuple[bytes, ...]]]:
        future = asyncio.get_running_loop().create_future()
        if self.died.done():
            future.set_exception(WorkerDiedError())
        else:
            self._expected = future
        return future

    async def _listen(self) -> None:
        try:
            while True:
                head, pieces = await channel.listen(self._reader)
                if isinstance(head, Report):
                    if self._listener is not None:
                        self._listener(head, b"".join(pieces))
                elif self._expected is not None:
                    expected, self._expected = self._expected, None
                    if not expected.done():
                        expected.set_result((head, pieces))
                    del expected
                # An answer may have hundreds of megabytes, and the next one may be far off.
                del head, pieces
        except (EOFError, OSError):
            pass
        finally:
            self._process.kill()
            self._writer.close()
            self.died.set_result(None)
            if self._expected is not None and not self._expected.done():
                self._expected.set_exception(WorkerDiedError())
            await asyncio.to_thread(self._process.wait)
