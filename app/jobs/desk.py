"""Where jobs are asked for and asked about; `app.jobs.keeper` does them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.answers import Answer, Unchanged, is_known
from app.errors import Outdated
from app.jobs.executor import Finished
from app.jobs.keeper import Keeper
from app.settings import Settings
from app.store import jobs, requests
from app.store.database import Connection, Database
from app.store.requests import Reply
from app.store.results import Result, Results


class Desk:
    """All that requests do with jobs, over one database."""

    def __init__(
        self, settings: Settings, database: Database, results: Results, keeper: Keeper
    ) -> None:
        self._settings, self._database, self._results = settings, database, results
        self._keeper = keeper
        self.listeners = keeper.listeners

    async def reply_to(self, request: str | None) -> Reply | None:
        """What a request was answered that started a job before. Raises `StoreUnavailable`."""
        if request is None:
            return None
        return await self._database.read(lambda connection: requests.find(connection, request))

    async def submit(
        self, job: jobs.NewJob, reply: Callable[[jobs.Job], Reply], request: str | None
    ) -> Reply:
        """Put a job in line, and make a reply of it; of the same ``request`` only once.

        Raises `Overloaded` and `StoreUnavailable`.
        """
        most = self._settings.max_jobs_waiting

        def work(connection: Connection) -> Reply:
            if request is not None and (known := requests.find(connection, request)) is not None:
                return known
            made = reply(jobs.create(connection, job, most))
            if request is not None:
                requests.keep(connection, request, made)
            return made

        try:
            made = await self._database.write(work)
        except Outdated:  # the same request came twice at a time, and the other one was first
            made = await self._database.write(work)
        self._keeper.wake()
        return made

    async def find(self, job: str) -> jobs.Job | None:
        """How a job is now. Raises `StoreUnavailable`."""
        found = await self._database.read(lambda connection: jobs.find(connection, job))
        return None if found is None else self._keeper.now(found)

    async def listing(self, owner: str | None, before: str | None, limit: int) -> list[jobs.Job]:
        """Jobs as `app.store.jobs.listing` gives them. Raises `StoreUnavailable`."""
        found = await self._database.read(
            lambda connection: jobs.listing(connection, owner, before, limit)
        )
        return [self._keeper.now(job) for job in found]

    async def result(self, key: str, known: frozenset[str]) -> Finished | None:
        """What a job has made, if it is still there; ``known`` are answers that the asker has."""
        if (found := await self._results.get(key)) is None:
            return None
        answer = answer_of(found)
        if answer.etag is not None and is_known(answer.etag, known):
            return Finished(Unchanged(answer.etag), (), 0.0, ())
        return Finished(answer, found.pieces, 0.0, ())

    async def cancel(self, job: str) -> bool:
        """End a job whose result nobody wants; False where it was over. Raises `StoreUnavailable`.

        If no other job asks the same, its work stops at once.
        """
        done = await self._database.write(partial(jobs.cancel, job=job))
        self._keeper.leave(job)
        return done


def answer_of(found: Result) -> Answer:
    """What was kept, as an answer without its body."""
    notes = found.notes
    return Answer(b"", found.media_type, notes["etag"], notes["name"], notes["notes"])
