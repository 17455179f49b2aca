"""Jobs on a Dask cluster. Its scheduler remembers nothing when it dies: the database does.

Works whose scheduler is lost are handed in again when there is one; those whose Dask worker is
lost, Dask itself gives to another.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import secrets
from contextlib import suppress
from typing import Any, Self

import structlog
from distributed import Client, KilledWorker

from app.answers import JoinOptions, Options
from app.errors import WorkerLost
from app.jobs import errand
from app.jobs.crew import LocalCrew, settings_for_jobs
from app.jobs.executor import Finished, Witness, lost_after, outcome_of
from app.jobs.process import Listener
from app.jobs.work import SOON_OVER, Reply, Report, Work
from app.settings import Settings

log = structlog.get_logger("tubeloom.jobs")

CONNECT_SECONDS = 5.0
LOOK_SECONDS = 2.0
"""Between two looks how many workers there are, and after a scheduler was lost."""

CLOSE_SECONDS = 3.0

_LOSSES = (OSError, concurrent.futures.CancelledError, errand.UnwantedError)
"""What a work may end with that is not to blame for it."""


class ClusterCrew:
    """The workers of a cluster. Use it as an asynchronous context manager.

    Frames are made films in a worker process of this service, so that they need not travel again.
    """

    def __init__(self, settings: Settings, witness: Witness | None = None) -> None:
        self._address = settings.dask_scheduler
        self._settings = settings_for_jobs(settings)
        self._local = LocalCrew(settings, witness)
        self._witness = witness
        self._topic = f"tubeloom-{secrets.token_hex(8)}"
        self._client: Client | None = None
        self._ready = asyncio.Event()
        self._listeners: dict[str, Listener] = {}
        self._cancelling: set[asyncio.Task[None]] = set()
        self._looking: asyncio.Task[None] | None = None
        self.width = 1
        """How many works are done at a time, as far as is known."""

    async def __aenter__(self) -> Self:
        await self._local.__aenter__()
        self._looking = asyncio.create_task(self._look())
        return self

    async def __aexit__(self, *_: object) -> None:
        if self._looking is not None:
            self._looking.cancel()
            await asyncio.gather(self._looking, *self._cancelling, return_exceptions=True)
        await self._leave()
        await self._local.__aexit__()

    async def answer(
        self,
        document: bytes,
        options: Options,
        listener: Listener,
        layout: bytes | None,
        until: float,
    ) -> Finished:
        """One attempt. Raises what the pipeline raises, and `WorkerLost`.

        The time that the work waits for a Dask worker is not known there.
        """
        if isinstance(options, JoinOptions):
            return await self._local.answer(document, options, listener, layout, until)
        clock = asyncio.get_running_loop().time
        while True:
            client = await self._connected(listener)
            seconds = max(until - clock(), SOON_OVER)
            work = Work(options, reports=True, layout=layout, seconds=seconds)
            try:
                reply, body = await self._once(client, work, document, listener)
            except KilledWorker:
                raise WorkerLost(lost_after(1)) from None
            except Exception as error:
                if client.status == "running" and not isinstance(error, _LOSSES):
                    raise
                log.warning("cluster lost a work, which is handed in again", error=repr(error))
                await asyncio.sleep(LOOK_SECONDS / 4)
                continue
            if not isinstance(reply, Reply):
                raise WorkerLost(lost_after(1))
            return Finished(outcome_of(reply), (body,), 0.0, reply.stages)

    async def _connected(self, listener: Listener) -> Client:
        while (client := self._client) is None or client.status != "running":
            listener(Report("waiting for the cluster", 0.0), b"")
            await self._ready.wait()
            await asyncio.sleep(LOOK_SECONDS / 8)
        return client

    async def _once(
        self, client: Client, work: Work, document: bytes, listener: Listener
    ) -> tuple[Reply | errand.ChildLost, bytes]:
        key = f"tubeloom-{secrets.token_hex(8)}"
        self._listeners[key] = listener
        future = client.submit(
            errand.run, key, work, document, self._settings, self._topic, key=key, pure=False
        )
        try:
            found: tuple[Reply | errand.ChildLost, bytes] = await future
        except asyncio.CancelledError:
            cancelling = asyncio.create_task(_cancel(client, future))
            self._cancelling.add(cancelling)
            cancelling.add_done_callback(self._cancelling.discard)
            raise
        finally:
            del self._listeners[key]
        return found

    async def _look(self) -> None:
        """Keep connected, and know how many work, for ever."""
        while True:
            try:
                await self._count()
            except (OSError, ValueError, concurrent.futures.CancelledError) as error:
                log.warning("no scheduler", address=self._address, error=repr(error))
                await self._leave()
            except Exception:
                log.exception("unexpected error")
            await asyncio.sleep(LOOK_SECONDS)

    async def _count(self) -> None:
        client = self._client
        if client is None or client.status != "running":
            await self._leave()
            client = await Client(  # type: ignore[no-untyped-call]
                self._address,
                asynchronous=True,
                set_as_default=False,
                timeout=CONNECT_SECONDS,
                name="tubeloom",
            )
            client.subscribe_topic(self._topic, self._hear)
            self._client = client
            log.info("scheduler found", address=self._address)
            self._ready.set()
        async with asyncio.timeout(CONNECT_SECONDS):
            threads: dict[str, int] = await client.nthreads()
        self.width = max(sum(threads.values()), 1)

    async def _leave(self) -> None:
        self._ready.clear()
        client, self._client = self._client, None
        if client is not None:
            with suppress(Exception):
                async with asyncio.timeout(CLOSE_SECONDS):
                    await client.close()  # type: ignore[no-untyped-call]

    def _hear(self, event: tuple[float, dict[str, Any]]) -> None:
        _, told = event
        if (listener := self._listeners.get(told["key"])) is not None:
            listener(Report(told["stage"], told["share"]), b"")


async def _cancel(client: Client, future: Any) -> None:
    with suppress(Exception):
        await client.cancel([future], force=True)  # type: ignore[no-untyped-call]
