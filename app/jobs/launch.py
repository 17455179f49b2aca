"""Starts the interpreter of a worker: so light that it can be done before anything is imported."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Launched:
    """A process that imports what it needs, and then waits at its ``end`` for the settings."""

    process: subprocess.Popen[bytes]
    end: socket.socket

    def drop(self) -> None:
        """End it, and wait until it is gone."""
        self.process.kill()
        self.end.close()
        self.process.wait()


def launch() -> Launched:
    """Start a process.

    It is started afresh, never forked: a copy of a process with threads and graphics contexts
    hangs sooner or later.
    """
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
    return Launched(process, ours)


@contextmanager
def launched(number: int) -> Iterator[list[Launched]]:
    """So many processes, from which whoever uses one takes it out; the others end here."""
    processes = [launch() for _ in range(number)]
    try:
        yield processes
    finally:
        for each in processes:
            each.drop()
