"""Who listens to which job in this service."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

from app.jobs.recent import Recent
from app.jobs.work import Report

Heard: TypeAlias = Recent[Report | None]
"""Reports of a job that this service works on; ``None`` says to look how it is now."""


class Listeners:
    """Queues of all who listen, by job."""

    def __init__(self) -> None:
        self._queues: dict[str, set[Heard]] = {}
        self.is_ending = False
        """Whether all should go: the service ends, and they may come back to another one."""

    @property
    def count(self) -> int:
        """How many listen."""
        return sum(map(len, self._queues.values()))

    @contextmanager
    def listening(self, job: str) -> Iterator[Heard]:
        """What is told of a job from now on."""
        heard: Heard = Recent()
        self._queues.setdefault(job, set()).add(heard)
        try:
            yield heard
        finally:
            self._queues[job].discard(heard)
            if not self._queues[job]:
                del self._queues[job]

    def tell(self, jobs: Iterable[str], report: Report | None) -> None:
        """Tell whoever listens to one of ``jobs``."""
        for job in jobs:
            for heard in self._queues.get(job, ()):
                heard.add(report)

    def end(self) -> None:
        """Let all go."""
        self.is_ending = True
        self.tell(list(self._queues), None)
