"""Whether the service lives, and whether it can work."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import Literal

import structlog
from fastapi import APIRouter
from pydantic import BaseModel, Field
from starlette.requests import Request
from starlette.responses import JSONResponse

from app.answers import RenderOptions
from app.errors import Overloaded, RendererUnavailable, TubeloomError
from app.jobs.executor import NOT_DRAWN, WorkerPool
from app.output.media import SceneFormat
from app.store.database import Database
from app.store.health import check

log = structlog.get_logger("tubeloom.health")

router = APIRouter(tags=["health"])

PIXEL = RenderOptions(SceneFormat.PNG, width=1, height=1)
SCENE = b'{"items": [{"id": "a"}, {"id": "b"}], "hyperedges": [{"id": "e", "attachments": \
[{"item": "a"}, {"item": "b"}]}]}'


class Health(BaseModel):
    """The process answers."""

    status: Literal["ok"] = "ok"


class Workers(BaseModel):
    """Processes that do the work."""

    wanted: int
    warm: int = Field(description="Alive, and past their first call.")
    problem: str | None = Field(
        None, description="Why one did not draw a pixel, when it was last asked to."
    )


class Draft(BaseModel):
    """Whether draft pictures can be drawn here: whether the last one that was asked for came."""

    available: bool
    problem: str | None = Field(description="Why they do not come, and what to install.")


class Store(BaseModel):
    """Whether what is stored can be read."""

    available: bool
    problem: str | None = None


class Readiness(BaseModel):
    """Whether work would be done at once. Degraded: all but draft pictures."""

    status: Literal["ready", "degraded", "starting", "broken"]
    workers: Workers
    draft: Draft
    database: Store


@dataclass(frozen=True, slots=True)
class Findings:
    """What does not work, if it does not."""

    workers: str | None
    database: str | None


class Examiner:
    """Tries out what a service is made of, now and then, and only when somebody asks.

    What was found is believed for so many ``seconds``, so that asking costs next to nothing; and
    what takes longer does not work, as far as whoever asks can tell.
    """

    def __init__(self, pool: WorkerPool, database: Database, seconds: float) -> None:
        self._pool, self._database, self._seconds = pool, database, seconds
        self._until = 0.0
        self._found = Findings(None, None)
        self._lock = asyncio.Lock()
        self._drawing: asyncio.Task[str | None] | None = None

    async def examine(self) -> Findings:
        """What was found in the last seconds, or is found now."""
        async with self._lock:
            if time.monotonic() >= self._until:
                workers, database = await asyncio.gather(self._draw(), self._read())
                if workers or database:
                    log.warning("not ready", workers=workers, database=database)
                self._found = Findings(workers, database)
                # While workers start, and until one has drawn, the next who asks looks again.
                if self._pool.draft_problem != NOT_DRAWN:
                    self._until = time.monotonic() + self._seconds
        return self._found

    async def _draw(self) -> str | None:
        """Let a worker draw; where all are at work, they prove by it that they can."""
        if self._drawing is None:
            if not self._pool.warm or self._pool.busy >= self._pool.warm:
                return None
            # Not stopped here, but at the deadline: the first picture may compile kernels.
            self._drawing = asyncio.create_task(self._pixel())
        await asyncio.wait({self._drawing}, timeout=self._seconds)
        if not self._drawing.done():
            return f"A worker has not drawn a pixel within {self._seconds:g} seconds."
        problem, self._drawing = self._drawing.result(), None
        return problem

    async def _pixel(self) -> str | None:
        try:
            await self._pool.answer(SCENE, PIXEL)
        except (Overloaded, RendererUnavailable):
            return None
        except TubeloomError as error:
            return str(error)
        except Exception:
            log.exception("unexpected error")
            return "A worker failed at drawing a pixel; the log says how."
        return None

    async def _read(self) -> str | None:
        try:
            async with asyncio.timeout(self._seconds):
                await self._database.read(check)
        except TimeoutError:
            return f"It did not answer within {self._seconds:g} seconds."
        except TubeloomError as error:
            return str(error)
        except Exception:
            log.exception("unexpected error")
            return "It cannot be read; the log says why."
        return None


@router.get("/healthz")
async def healthz() -> Health:
    """Whether the service lives."""
    return Health()


@router.get(
    "/readyz",
    response_model=Readiness,
    responses={503: {"model": Readiness, "description": "No worker is warm, or one failed."}},
)
async def readyz(request: Request) -> JSONResponse:
    """Whether the service can work, and whether it can draw: a worker is made to, now and then."""
    pool: WorkerPool = request.app.state.pool
    examiner: Examiner = request.app.state.examiner
    found = await examiner.examine()
    readiness = Readiness(
        status=_status(pool, found),
        workers=Workers(
            wanted=request.app.state.settings.workers, warm=pool.warm, problem=found.workers
        ),
        draft=Draft(available=pool.draft_problem is None, problem=pool.draft_problem),
        database=Store(available=found.database is None, problem=found.database),
    )
    is_ready = readiness.status in {"ready", "degraded"}
    return JSONResponse(readiness.model_dump(), status_code=200 if is_ready else 503)


def _status(
    pool: WorkerPool, found: Findings
) -> Literal["ready", "degraded", "starting", "broken"]:
    if found.workers or found.database:
        return "broken"
    if not pool.warm:
        return "starting"
    return "degraded" if pool.draft_problem else "ready"
