"""Whether the service lives, and whether it can work."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from pydantic import BaseModel, Field
from starlette.requests import Request
from starlette.responses import JSONResponse

from app.jobs.executor import WorkerPool

router = APIRouter(tags=["health"])


class Health(BaseModel):
    """The process answers."""

    status: Literal["ok"] = "ok"


class Workers(BaseModel):
    """Processes that do the work."""

    wanted: int
    warm: int = Field(description="Alive, and past their first call.")


class Draft(BaseModel):
    """Whether draft pictures can be drawn here."""

    available: bool
    problem: str | None = Field(description="What is missing, and how to install it.")


class Readiness(BaseModel):
    """Whether work would be done at once. Degraded: all but draft pictures."""

    status: Literal["ready", "degraded", "starting"]
    workers: Workers
    draft: Draft


@router.get("/healthz")
async def healthz() -> Health:
    """Whether the service lives."""
    return Health()


@router.get(
    "/readyz",
    response_model=Readiness,
    responses={503: {"model": Readiness, "description": "No worker is warm yet."}},
)
async def readyz(request: Request) -> JSONResponse:
    """Whether the service can work, and whether it can draw."""
    pool: WorkerPool = request.app.state.pool
    readiness = Readiness(
        status="starting" if not pool.warm else "degraded" if pool.draft_problem else "ready",
        workers=Workers(wanted=request.app.state.settings.workers, warm=pool.warm),
        draft=Draft(available=pool.draft_problem is None, problem=pool.draft_problem),
    )
    return JSONResponse(readiness.model_dump(), status_code=200 if pool.warm else 503)
