"""One worker process, as the service sees it."""

from __future__ import annotations

import asyncio
import os
import socket
import subprocess
import sys
from collections.abc import Callable

from app.jobs import channel
from app.jobs.work import Crash, Ready, Reply, Report, Work
from app.settings import Settings

Listener = Callable[[Report, bytes], None]
"""Told how a work goes on; with a preview, or with no bytes."""


class WorkerDiedError(Exception):
    """The process ended before it replied."""


class WorkerProcess:
    """A process that answers one work at a time.

    It is started afresh, never forked: a copy of a process with threads and graphics contexts
    hangs sooner or later.
    """

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
        self.died: asyncio.Future[None] = loop.create_future()
        self._listening = loop.create_task(self._listen())

    @classmethod
    async def start(cls, settings: Settings) -> WorkerProcess:
        """Start a process. It may be asked once `ready` has returned."""
        ours, theirs = socket.socketpair()
        with theirs:
            process = subprocess.Popen(  # noqa: S603 - our own interpreter and module
                [
                    *(sys.executable, "-P", "-X", "faulthandler"),
                    *("-m", "app.jobs.worker", str(theirs.fileno())),
                ],
                stdin=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            )
        ours.setblocking(False)
        reader, writer = await asyncio.open_unix_connection(sock=ours, limit=1 << 22)
        worker = cls(process, reader, writer)
        channel.post(writer, settings)
        return worker

    @property
    def pid(self) -> int:
        """The process's number."""
        return self._process.pid

    async def ready(self) -> Ready | Crash:
        """Wait until it is warm, or has failed to become so. Raises `WorkerDiedError`."""
        head, _ = await self._next()
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
                elif self._expected is not None and not self._expected.done():
                    self._expected.set_result((head, pieces))
        except (EOFError, OSError):
            pass
        finally:
            self._process.kill()
            self._writer.close()
            self.died.set_result(None)
            if self._expected is not None and not self._expected.done():
                self._expected.set_exception(WorkerDiedError())
            await asyncio.to_thread(self._process.wait)
