"""Who does the work of jobs: worker processes of their own, beside those of plain requests."""

from __future__ import annotations

import asyncio
import math
from contextlib import AbstractAsyncContextManager, AsyncExitStack
from typing import Protocol, Self

from app.answers import Options
from app.jobs.executor import Finished, Witness, WorkerPool
from app.jobs.process import Listener
from app.settings import Settings

MOST_WORKS = 10_000
"""That stand in the pool's line: parts of jobs, whose number is bounded elsewhere."""


class Crew(Protocol):
    """Does works. One that is cancelled frees the processor at once."""

    @property
    def width(self) -> int:
        """How many works are done at a time."""

    async def answer(
        self,
        document: bytes,
        options: Options,
        listener: Listener,
        layout: bytes | None,
        until: float,
    ) -> Finished:
        """One attempt, that is over when the clock of the event loop shows ``until``.

        Raises what the pipeline raises, and `WorkerLost`.
        """


def settings_for_jobs(settings: Settings) -> Settings:
    """What workers of jobs go by: the deadline is another one."""
    return settings.model_copy(
        update={
            "workers": settings.job_workers,
            "deadline_seconds": settings.job_deadline_seconds,
            "max_waiting": MOST_WORKS,
        }
    )


def crew_of(
    settings: Settings, witness: Witness | None = None
) -> AbstractAsyncContextManager[Crew]:
    """Who does the jobs: the workers of a cluster, if the settings name one."""
    if settings.dask_scheduler:
        from app.jobs.cluster import ClusterCrew

        return ClusterCrew(settings, witness)
    return LocalCrew(settings, witness)


class LocalCrew:
    """Worker processes on this machine, which start when the first work comes.

    Use it as an asynchronous context manager.
    """

    def __init__(self, settings: Settings, witness: Witness | None = None) -> None:
        self._settings = settings_for_jobs(settings)
        self._witness = witness
        self._stack = AsyncExitStack()
        self._pool: WorkerPool | None = None
        self._starting = asyncio.Lock()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._stack.aclose()

    @property
    def width(self) -> int:
        """How many works are done at a time."""
        return self._settings.workers

    async def answer(
        self,
        document: bytes,
        options: Options,
        listener: Listener,
        layout: bytes | None,
        until: float,
    ) -> Finished:
        """One attempt. Raises what the pipeline raises, and `WorkerLost`."""
        pool = await self._started()
        return await pool.answer(document, options, listener=listener, layout=layout, until=until)

    async def _started(self) -> WorkerPool:
        async with self._starting:
            if self._pool is None:
                pool = WorkerPool(self._settings, attempts=1, line_seconds=math.inf)
                if self._witness is not None:
                    pool.witness = self._witness
                self._pool = await self._stack.enter_async_context(pool)
            return self._pool
