"""Jobs as answers and events tell of them."""

from __future__ import annotations

from datetime import datetime
from typing import Literal, Self

from pydantic import BaseModel, Field
from starlette.requests import Request

from app.api.problems import problem_of
from app.api.revision_model import moment
from app.api.schema import Problem
from app.jobs.failures import failure_of
from app.store.jobs import Job


class JobLinks(BaseModel):
    """Where else there is something of a job."""

    self: str
    events: str
    result: str


class JobModel(BaseModel):
    """How a job is."""

    id: str
    state: Literal["waiting", "running", "done", "failed", "cancelled"]
    stage: str | None = Field(description="What is being done.")
    share: float = Field(description="Of the whole that is done, 0 to 1.")
    attempts: int = Field(description="The work begins again where a process dies over it.")
    problem: Problem | None = Field(description="Why it failed.")
    format: str
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    links: JobLinks

    @classmethod
    def of(cls, request: Request, job: Job) -> Self:
        """A job as it is told."""
        return cls(
            id=job.id,
            state=job.state,
            stage=job.stage,
            share=round(job.share, 4),
            attempts=job.attempts,
            problem=None if job.problem is None else _problem(request, job.problem),
            format=job.options.format.value,
            created_at=moment(job.created_at),
            started_at=_moment(job.started_at),
            finished_at=_moment(job.finished_at),
            links=JobLinks(
                self=path_of(job.id),
                events=f"{path_of(job.id)}/events",
                result=f"{path_of(job.id)}/result",
            ),
        )


class JobList(BaseModel):
    """Some jobs, the newest first."""

    jobs: tuple[JobModel, ...]
    next: str | None = Field(description="What to ask for `before`; null: there are no more.")


def path_of(job: str) -> str:
    """Where a job is."""
    return f"/v1/jobs/{job}"


def _problem(request: Request, failure: str) -> Problem:
    details = problem_of(request, failure_of(failure))
    details.pop("instance", None)  # which would name the request that asks now
    return Problem(**details)


def _moment(milliseconds: int | None) -> datetime | None:
    return None if milliseconds is None else moment(milliseconds)
