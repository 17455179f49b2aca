"""Does the jobs that the database holds, as many at a time as there are who work.

The database is what counts: a service that ends in the midst of a job leaves a lease that runs
out, and whoever looks next takes the job up.
"""

from __future__ import annotations

import asyncio
import math
import secrets
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Self, TypeVar

import structlog

from app.answers import Answer
from app.errors import DeadlineExceeded, StoreUnavailable, TubeloomError, WorkerLost
from app.jobs.crew import Crew
from app.jobs.executor import Finished, lost_after
from app.jobs.failures import failure_text
from app.jobs.films import Works
from app.jobs.listeners import Listeners
from app.jobs.running import Running
from app.jobs.work import Report
from app.settings import Settings
from app.store import jobs, leases
from app.store.database import Database
from app.store.results import Results

log = structlog.get_logger("tubeloom.jobs")

PULSE_SECONDS = 1.0
"""Between two notes of how jobs go on, which renew their leases too: those last twice as long at
least."""

LOOK_SECONDS = 1.0
"""Between two looks for jobs that other services put in line, or left."""

FORGET_SECONDS = 600.0
"""Between two sweeps of jobs that were over long ago."""

Found = TypeVar("Found")


class Keeper:
    """Works on jobs while it is open, as an asynchronous context manager."""

    def __init__(
        self, settings: Settings, database: Database, results: Results, crew: Crew
    ) -> None:
        self._settings, self._database, self._results = settings, database, results
        self._crew = crew
        self._lease_seconds = settings.job_lease_seconds
        self._name = secrets.token_hex(16)
        self._running: dict[str, Running] = {}
        self.listeners = Listeners()
        self._news = asyncio.Event()
        self._loops: list[asyncio.Task[None]] = []

    async def __aenter__(self) -> Self:
        loops = (self._look(), self._beat(), self._sweep())
        self._loops = [asyncio.create_task(loop) for loop in loops]
        return self

    async def __aexit__(self, *_: object) -> None:
        works = [running.work for running in self._running.values() if running.work is not None]
        for task in (*self._loops, *works):
            task.cancel()
        await asyncio.gather(*self._loops, *works, return_exceptions=True)
        with suppress(StoreUnavailable):  # then the leases run out
            await self._database.write(lambda connection: leases.release(connection, self._name))

    def wake(self) -> None:
        """Look for jobs at once."""
        self._news.set()

    def leave(self, job: str) -> None:
        """Somebody cancelled a job; if no other job asks the same, its work stops at once."""
        for running in list(self._running.values()):
            running.leave(job)
        self.listeners.tell({job}, None)

    def now(self, job: jobs.Job) -> jobs.Job:
        """The job as it goes on here: of what the database holds, this is the newest."""
        running = self._running.get(job.digest)
        if job.state != "running" or running is None or job.id not in running.jobs:
            return job
        stage, share, attempts = running.mark
        return replace(job, stage=stage, share=share, attempts=attempts)

    async def _look(self) -> None:
        """Take up jobs that wait, for ever."""
        while True:
            try:
                await self._take_up()
            except StoreUnavailable:
                log.warning("jobs cannot be taken up, the database does not answer")
            except Exception:
                log.exception("unexpected error")
            with suppress(TimeoutError):
                async with asyncio.timeout(LOOK_SECONDS):
                    await self._news.wait()
            self._news.clear()

    async def _take_up(self) -> None:
        if not await self._database.read(leases.is_work_there):
            return
        slots = max(self._settings.job_workers, self._crew.width) - len(self._running)
        at_work = {digest: running.takes_more for digest, running in self._running.items()}
        most = self._settings.job_attempts
        lost = failure_text(WorkerLost(lost_after(most)))
        claimed = await self._database.write(
            lambda connection: leases.claim(
                connection, self._name, self._lease_seconds, slots, at_work, most, lost
            )
        )
        self.listeners.tell(claimed.given_up, None)
        for digest, joined in claimed.joined.items():
            running = self._running.get(digest)
            if running is not None and running.takes_more:
                running.jobs |= joined
                self.listeners.tell(joined, None)
            else:  # it ended just then
                await self._database.write(partial(leases.release, by=self._name, only=joined))
                self._news.set()
        for task in claimed.tasks:
            running = Running(task)
            self._running[task.digest] = running
            running.work = asyncio.create_task(self._work(running))
            running.work.add_done_callback(partial(self._free, running))
            self.listeners.tell(task.jobs, None)

    async def _work(self, running: Running) -> None:
        """Work on a task until it is over."""
        try:
            await self._end(running)
        except asyncio.CancelledError:
            log.info("job left", digest=running.task.digest)
            raise
        except Exception:  # the lease runs out, and somebody takes the job up again
            log.exception("unexpected error")

    def _free(self, running: Running, _work: asyncio.Task[None]) -> None:
        """Free the place of a task whose work has ended, be it before its first step."""
        if self._running.get(running.task.digest) is running:
            del self._running[running.task.digest]
        self._news.set()

    async def _end(self, running: Running) -> None:
        task = running.task
        result, problem = None, None
        try:
            result = await self._insist(lambda: self._known(task))
            if result is None:
                finished = await self._done(running)
                result = await self._insist(lambda: self._keep(task, finished))
        except TubeloomError as error:
            problem = failure_text(error)
        except Exception as error:
            log.exception("unexpected error")
            problem = failure_text(error)
        running.is_ending = True
        ended = await self._insist(
            lambda: self._database.write(
                lambda connection: leases.finish(
                    connection, self._name, task.digest, result=result, problem=problem
                )
            )
        )
        log.info("job over", jobs=sorted(ended), problem=problem, attempts=running.attempts)
        self.listeners.tell(ended | running.jobs, None)

    async def _done(self, running: Running) -> Finished:
        """The answer, in time. Raises what the pipeline raises, and `DeadlineExceeded`."""
        task = running.task

        def listen(report: Report, preview: bytes) -> None:
            if not preview and running.note(report):
                self.listeners.tell(running.jobs, report)

        most = self._settings.job_attempts
        try:
            async with asyncio.timeout(task.deadline_seconds) as limit:
                until = limit.when() or math.inf
                return await Works(self._crew, running, most, until).all(listen)
        except TimeoutError:
            if not limit.expired():
                raise
            raise DeadlineExceeded(
                f"The job took longer than {task.deadline_seconds:g} seconds."
            ) from None

    async def _known(self, task: leases.Task) -> str | None:
        """The key of the answer, if it is among the results; then it stays there."""
        if await self._results.get(task.digest) is None:
            return None
        return task.digest if await self._results.keep(task.digest, self._until()) else None

    async def _keep(self, task: leases.Task, finished: Finished) -> str:
        """Put an answer among the results, and say under which key.

        Where another attempt may give another answer, so that it has no validator, the key is new.
        """
        answer = finished.answer
        if not isinstance(answer, Answer):
            raise TypeError("A worker knew an answer that nobody had.")
        key = task.digest if answer.etag is not None else secrets.token_hex(32)
        notes = {"etag": answer.etag, "name": answer.name, "notes": dict(answer.notes)}
        await self._results.put(key, finished.pieces, answer.media_type, notes, self._until())
        return key

    def _until(self) -> int:
        """How long what a job makes is kept, in milliseconds since 1970."""
        return round(1000 * (time.time() + 3600 * self._settings.job_result_hours))

    async def _insist(self, call: Callable[[], Awaitable[Found]]) -> Found:
        """What ``call`` gives, once what is stored can be reached again."""
        while True:
            try:
                return await call()
            except StoreUnavailable:
                log.warning("the end of a job cannot be written down yet")
                await asyncio.sleep(PULSE_SECONDS)

    async def _beat(self) -> None:
        """Renew leases and note progress, for ever; leave what is not ours any more."""
        while True:
            await asyncio.sleep(PULSE_SECONDS)
            if not self._running:
                continue
            shares = {digest: running.mark for digest, running in self._running.items()}
            asked = {digest: frozenset(running.jobs) for digest, running in self._running.items()}
            try:
                left = await self._database.write(
                    partial(
                        leases.pulse,
                        by=self._name,
                        lease_seconds=self._lease_seconds,
                        shares=shares,
                    )
                )
            except StoreUnavailable:
                continue
            except Exception:
                log.exception("unexpected error")
                continue
            for digest, ours in left.items():
                if (running := self._running.get(digest)) is not None:
                    for job in asked[digest] - ours:
                        running.leave(job)
                        self.listeners.tell({job}, None)

    async def _sweep(self) -> None:
        """Forget jobs that were over long ago, for ever."""
        while True:
            before = round(1000 * (time.time() - 3600 * self._settings.job_result_hours))
            with suppress(StoreUnavailable):
                await self._database.write(partial(jobs.forget, before=before))
            await asyncio.sleep(FORGET_SECONDS)
