"""Whoever hears what happens to a stored program, with either client."""

from __future__ import annotations

import json
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from queue import Queue
from typing import Any

from tubeloom_client import Happening, Program

from tests.service import PATIENCE_SECONDS, Service


class Watcher(threading.Thread):
    """Hears what happens to a program, until it is deleted."""

    def __init__(self, program: Program) -> None:
        super().__init__(daemon=True)
        self.heard: Queue[Happening] = Queue()
        self._program = program
        self.start()

    def run(self) -> None:
        for happening in self._program.watch():
            self.heard.put(happening)

    def next(self) -> Happening:
        """What happens next."""
        return self.heard.get(timeout=PATIENCE_SECONDS)

    def all(self) -> list[Happening]:
        """What has happened until the end, and has not been asked for yet."""
        self.join(PATIENCE_SECONDS)
        assert not self.is_alive()
        return [self.heard.get() for _ in range(self.heard.qsize())]


@contextmanager
def watching_in_node(
    drivers: Path, service: Service, program: str
) -> Iterator[subprocess.Popen[str]]:
    """A process that writes down what happens to a program."""
    command = ["node", "watch.js", service.url, program]
    watcher = subprocess.Popen(command, cwd=drivers, stdout=subprocess.PIPE, text=True)
    try:
        yield watcher
    finally:
        watcher.kill()
        watcher.communicate()


def heard(watcher: subprocess.Popen[str]) -> dict[str, Any]:
    """What it writes next."""
    assert watcher.stdout is not None
    found: dict[str, Any] = json.loads(watcher.stdout.readline())
    return found
