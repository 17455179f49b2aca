"""Starting jobs, by a call of their own or in place of an answer that would take long."""

from __future__ import annotations

import asyncio

from starlette.requests import Request
from starlette.responses import Response

from app.answers import RenderOptions
from app.api import guard
from app.api.job_model import JobModel, path_of
from app.api.once import check_is_same, fingerprint_of, request_of
from app.api.prefer import Preferences
from app.api.scopes import Scope
from app.jobs.answering import Answering
from app.jobs.cost import estimate
from app.jobs.desk import Desk
from app.settings import Settings
from app.store.jobs import Job, NewJob, new_id
from app.store.requests import Reply

RETRY_SECONDS = 1
"""When it is worth to look again how a job is."""


async def start(
    request: Request,
    document: bytes,
    options: RenderOptions,
    layout: bytes | None = None,
    body: bytes = b"",
    applied: str | None = None,
) -> Response:
    """Put a job in line, and say where it is; once, if the request has an ``Idempotency-Key``.

    Raises `ReusedKeyError`, `TooManyRequestsError`, `Overloaded` and `StoreUnavailable`.
    """
    settings: Settings = request.app.state.settings
    answering: Answering = request.app.state.answering
    desk: Desk = request.app.state.desk
    name, fingerprint = request_of(request), fingerprint_of(request, body)
    if (known := await desk.reply_to(name)) is not None:
        check_is_same(known, fingerprint)
        return _response(known)
    guard.afford(min(estimate(options, len(document)), settings.job_deadline_seconds))
    job = NewJob(
        new_id(),
        await asyncio.to_thread(answering.key, document, options, layout),
        guard.key_of(request),
        document,
        layout,
        options,
        settings.job_deadline_seconds,
    )

    def reply(made: Job) -> Reply:
        headers = {
            "Content-Type": "application/json",
            "Location": path_of(made.id),
            "Retry-After": str(RETRY_SECONDS),
            "Cache-Control": "no-store",
            **({} if applied is None else {"Preference-Applied": applied}),
        }
        return Reply(
            fingerprint, 202, headers, JobModel.of(request, made).model_dump_json().encode()
        )

    answered = await desk.submit(job, reply, name)
    check_is_same(answered, fingerprint)
    return _response(answered)


async def start_if_long(
    request: Request, document: bytes, options: RenderOptions, preferences: Preferences
) -> Response | None:
    """A job in place of an answer, if the client would rather not wait, and it would for long."""
    settings: Settings = request.app.state.settings
    if not preferences.respond_async or not guard.has(request, Scope.JOBS):
        return None
    patience = settings.deadline_seconds if preferences.wait is None else preferences.wait
    if estimate(options, len(document)) <= min(patience, settings.deadline_seconds):
        return None
    return await start(request, document, options, body=document, applied=preferences.applied)


def _response(reply: Reply) -> Response:
    return Response(reply.body, reply.status, dict(reply.headers))
