"""Whoever hears what happens to a stored program, with either client."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from queue import Queue
from typing import Any

from tubeloom_client import Happening, Program

from tests.children import Child
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


def watching_in_node(drivers: Path, service: Service, program: str) -> Child:
    """A process that writes down what happens to a program."""
    return Child(["node", "watch.js", service.url, program], cwd=drivers)


def heard(watcher: Child) -> dict[str, Any]:
    """What it writes next."""
    found: dict[str, Any] = json.loads(watcher.hear())
    return found
