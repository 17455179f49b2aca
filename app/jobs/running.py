"""A task that is being worked on."""

from __future__ import annotations

import asyncio

from app.jobs.work import Report
from app.store.leases import Task


class Running:
    """How far a task is, and the ``jobs`` that still want it."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.jobs: set[str] = set(task.jobs)
        self.attempts = task.attempts
        self.work: asyncio.Task[None] | None = None
        self.is_ending = False
        self._stage: str | None = None
        self._share = 0.0

    @property
    def mark(self) -> tuple[str | None, float, int]:
        """Stage, share and attempts."""
        return self._stage, self._share, self.attempts

    @property
    def takes_more(self) -> bool:
        """Whether jobs that ask the same may join: the work neither ends nor stops."""
        return bool(self.jobs) and not self.is_ending

    def note(self, report: Report) -> bool:
        """How the work goes on. False where that is nothing new."""
        before, self._stage, self._share = (
            (self._stage, self._share),
            report.stage,
            report.share,
        )
        return before != (report.stage, report.share)

    def leave(self, job: str) -> None:
        """A job wants it no more; where none is left, the work stops."""
        if job not in self.jobs:
            return
        self.jobs.discard(job)
        if not self.jobs and self.work is not None:
            self.work.cancel()
