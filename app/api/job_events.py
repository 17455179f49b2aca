"""How a job goes on, as server-sent events; whoever comes late hears at first how it is now."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator

from fastapi.sse import format_sse_event
from starlette.requests import Request

from app.api.job_model import JobModel
from app.errors import StoreUnavailable
from app.jobs.desk import Desk
from app.jobs.work import Report
from app.store.jobs import Job

LOOK_SECONDS = 1.0
"""Of silence, after which the database is asked: another service may work on the job."""

BEAT_SECONDS = 10.0
"""Of silence, after which a comment says that there is still somebody here."""

RETRY_MILLISECONDS = 1000
"""After which a browser whose connection breaks comes back."""


async def job_events(request: Request, desk: Desk, job: Job) -> AsyncIterator[bytes]:
    """Events from now until the job is over, or the service ends."""
    now = asyncio.get_running_loop().time
    with desk.listeners.listening(job.id) as heard:
        told: object = None
        spoke = now()
        yield format_sse_event(retry=RETRY_MILLISECONDS, comment="events of a job")
        found: Job | None = await _look(desk, job.id)
        while not desk.listeners.is_ending:
            if found is not None and found.is_over:
                yield format_sse_event(
                    event=found.state, data_str=JobModel.of(request, found).model_dump_json()
                )
                return
            if found is not None and (found.state, found.stage, found.share) != told:
                told, spoke = (found.state, found.stage, found.share), now()
                yield _news(found)
            elif now() > spoke + BEAT_SECONDS:
                spoke = now()
                yield format_sse_event(comment="still at work")
            try:
                async with asyncio.timeout(LOOK_SECONDS):
                    report = await heard.get()
                    while report is not None:
                        told, spoke = ("running", report.stage, report.share), now()
                        yield _progress(report)
                        report = await heard.get()
            except TimeoutError:
                pass
            found = await _look(desk, job.id)


async def _look(desk: Desk, job: str) -> Job | None:
    """How it is; ``None`` where that cannot be told now."""
    try:
        return await desk.find(job)
    except StoreUnavailable:
        return None


def _news(job: Job) -> bytes:
    if job.state == "running":
        return _progress(Report(job.stage or "starting", job.share))
    return format_sse_event(event="waiting", data_str="{}")


def _progress(report: Report) -> bytes:
    data = {"stage": report.stage, "share": round(report.share, 4)}
    return format_sse_event(event="progress", data_str=json.dumps(data))
