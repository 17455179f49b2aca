"""Jobs: renders that take longer than anybody should have to keep a connection open for."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter
from fastapi import Path as PathParameter
from fastapi import Query as QueryParameters
from pydantic import Field
from starlette.requests import Request
from starlette.responses import Response

from app.api import guard
from app.api.bodies import has_body, read_document, source_of
from app.api.conditions import known_tags
from app.api.event_streams import EventStream
from app.api.job_events import job_events
from app.api.job_model import JobList, JobModel
from app.api.job_schema import (
    describe_cancel,
    describe_events,
    describe_list,
    describe_result,
    describe_start,
    describe_state,
)
from app.api.problems import ContradictionError, JobNotDoneError, ResultGoneError
from app.api.queries import Query, RenderQuery
from app.api.responses import response_of
from app.api.scene_queries import render_options, scene_format
from app.api.scopes import Scope
from app.api.starting import start
from app.api.stored_programs import content_of
from app.api.unread import Unread
from app.errors import NotStored
from app.jobs.desk import Desk
from app.jobs.failures import failure_of
from app.settings import Settings
from app.store.jobs import Job

router = APIRouter(prefix="/v1/jobs", tags=["jobs"])

JobId = Annotated[str, PathParameter(alias="id", pattern=r"^[0-9a-f]{32}$")]

MOST_LISTED = 500


class JobQuery(RenderQuery):
    """What may be asked of a job: a scene, of the posted document or of a stored program."""

    program: str | None = Field(
        None,
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._~-]{0,199}$",
        description="A stored program, in place of a document in the body.",
    )
    revision: int | None = Field(
        None, ge=1, lt=2**31, description="Of the stored program; left out, the newest."
    )


class JobListQuery(Query):
    """Which part of the list."""

    limit: int = Field(50, ge=1, le=MOST_LISTED)
    before: str | None = Field(
        None, pattern=r"^[0-9a-f]{32}$", description="The part that follows this job."
    )


@router.post("", **describe_start())
async def start_job(request: Request, query: Annotated[JobQuery, QueryParameters()]) -> Response:
    """Render the posted document, or a stored program, as `POST /v1/render` does, but later.

    The answer says where the job is. Jobs that ask the same are worked on once. What a job makes is
    kept for a day.
    """
    wanted = scene_format(query, None)  # what is accepted is said of this answer
    if query.program is None:
        if query.revision is not None:
            raise ContradictionError("A posted document has no revision; name a program.")
        settings: Settings = request.app.state.settings
        document = await read_document(request, settings.max_body_bytes)
        options = render_options(query, wanted, source_of(request, query), query.wishes)
        return await start(request, document, options, body=document)
    if query.source not in {None, "tubeloom"} or await has_body(request):
        raise ContradictionError("Send a document, or name a stored program, not both.")
    if query.wishes:
        raise ContradictionError("A stored program is laid out already; change it instead.")
    guard.require(request, Scope.READ)
    content = await content_of(request, query.program, query.revision)
    options = render_options(query, wanted, "tubeloom")
    return await start(request, content.document, options, content.layout)


@router.get("", **describe_list())
async def list_jobs(request: Request, query: Annotated[JobListQuery, QueryParameters()]) -> JobList:
    """Jobs, the newest first, a part at a time: those of the key, or all for one with `admin`."""
    desk: Desk = request.app.state.desk
    owner = None if guard.has(request, Scope.ADMIN) else guard.key_of(request)
    found = await desk.listing(owner, query.before, query.limit + 1)
    page = found[: query.limit]
    return JobList(
        jobs=tuple(JobModel.of(request, job) for job in page),
        next=page[-1].id if len(found) > len(page) else None,
    )


@router.get("/{id}", **describe_state())
async def get_job(request: Request, job: JobId) -> JobModel:
    """How a job is."""
    return JobModel.of(request, await _visible(request, job))


@router.delete("/{id}", **describe_cancel())
async def cancel_job(request: Request, job: JobId) -> Response:
    """End a job whose result nobody wants. A job that is over stays as it is."""
    desk: Desk = request.app.state.desk
    await desk.cancel((await _visible(request, job)).id)
    return Response(status_code=204)


@router.get("/{id}/events", **describe_events())
async def watch_job(request: Request, job: JobId) -> Response:
    """How a job goes on: `waiting`, `progress`, and at last `done`, `failed` or `cancelled`.

    The first event tells how it is now, so whoever comes back has missed nothing that counts.
    """
    desk: Desk = request.app.state.desk
    return EventStream(
        job_events(request, desk, await _visible(request, job)),
        {"X-Accel-Buffering": "no"},
    )


@router.get("/{id}/result", **describe_result())
async def get_result(request: Request, job: JobId) -> Response:
    """What a job has made, as a plain request would have got it; of a failed job, its problem."""
    desk: Desk = request.app.state.desk
    found = await _visible(request, job)
    if found.problem is not None:
        raise failure_of(found.problem)
    if found.result is None:
        raise JobNotDoneError(f"There is no result: the job is {found.state}.")
    unread: Unread = request.app.state.unread
    unread.check()
    finished = await desk.result(found.result, known_tags(request.headers.get("if-none-match")))
    if finished is None:
        raise ResultGoneError("The result is not kept any more; start the job again.")
    return response_of(finished, found.options.format.value)


async def _visible(request: Request, job: str) -> Job:
    """The job, if the request may see it. Raises `NotStored` and `StoreUnavailable`."""
    desk: Desk = request.app.state.desk
    found = await desk.find(job)
    owner = guard.key_of(request)
    if found is None or (
        owner is not None and found.owner != owner and not guard.has(request, Scope.ADMIN)
    ):
        raise NotStored(f"There is no job {job} (any more).")
    return found
