"""What is noted of each work that a worker did: whoever asked pays for it, and figures grow."""

from __future__ import annotations

from app.api import guard
from app.api.metrics import Metrics
from app.api.tracing import Tracing
from app.jobs.executor import Witness
from app.jobs.work import Stage


def accountant(metrics: Metrics, tracing: Tracing | None) -> Witness:
    """Who notes works in all books."""

    def note(seconds: float, stages: tuple[Stage, ...]) -> None:
        guard.spend(seconds)
        metrics.note_work(seconds, stages)
        if tracing is not None:
            tracing.note_work(seconds, stages)

    return note
