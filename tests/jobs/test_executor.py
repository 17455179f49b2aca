"""The pool with real workers, without HTTP."""

from __future__ import annotations

import asyncio
import json
import os
import signal
from collections.abc import Callable, Coroutine, Iterator
from typing import Any

import psutil
import pytest

from app.answers import Answer, LayoutOptions, RenderOptions, Unchanged
from app.errors import DeadlineExceeded, InvalidDocument, OutOfMemory, Overloaded
from app.jobs.executor import SHORT_LINE, WorkerPool
from app.output.media import SceneFormat
from app.settings import Settings
from tests.service import PATIENCE_SECONDS, SMALL, is_worker, large_program, wide_program

DOCUMENT = json.dumps(SMALL).encode()
LARGE = large_program(300)

FILM = RenderOptions(SceneFormat.WEBP, 640, 480, frames=1000)
"""Which no machine draws in a second."""


Test = Callable[[WorkerPool], Coroutine[Any, Any, None]]


@pytest.fixture(scope="module")
def in_pool() -> Iterator[Callable[[Test], None]]:
    """Runs a test in a pool of one worker and a line of one place, which tests share."""
    pool = WorkerPool(Settings(workers=1, max_waiting=1, max_worker_bytes=512 * 1024**2))
    with asyncio.Runner() as runner:
        runner.run(pool.__aenter__())
        yield lambda test: runner.run(test(pool))
        runner.run(pool.__aexit__())


def in_new_pool(pool: WorkerPool, test: Test) -> None:
    async def run() -> None:
        async with pool:
            await test(pool)

    asyncio.run(run())


def worker_pids() -> set[int]:
    return {child.pid for child in psutil.Process().children() if is_worker(child)}


async def warm(pool: WorkerPool) -> None:
    """Have work done, as soon as there is a worker for it that does it in time."""
    while True:
        try:
            await pool.answer(DOCUMENT, LayoutOptions())
        except (Overloaded, DeadlineExceeded):
            await asyncio.sleep(0.01)
        else:
            return


def test_works_wait_for_the_first_worker_and_the_end_of_the_pool_is_that_of_its_workers() -> None:
    before = worker_pids()

    async def test(pool: WorkerPool) -> None:
        assert pool.warm == 0
        finished = await pool.answer(DOCUMENT, RenderOptions())
        assert isinstance(finished.answer, Answer)
        assert finished.pieces[0].startswith(b"glTF")
        assert finished.waited > 0
        assert pool.warm == 1
        assert finished.answer.etag
        again = await pool.answer(DOCUMENT, RenderOptions(), frozenset({finished.answer.etag}))
        assert again.answer == Unchanged(finished.answer.etag)

    in_new_pool(WorkerPool(Settings(workers=1)), test)
    assert worker_pids() == before


def test_errors_of_the_document_come_through_and_cost_no_worker(
    in_pool: Callable[[Test], None],
) -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        before = worker_pids()
        with pytest.raises(InvalidDocument) as caught:
            await pool.answer(b'{"items": 1}', RenderOptions())
        assert caught.value.faults[0].pointer == "/items"
        assert worker_pids() == before

    in_pool(test)


def test_a_worker_that_dies_idle_is_replaced_and_nobody_notices(
    in_pool: Callable[[Test], None],
) -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        (victim,) = worker_pids()
        os.kill(victim, signal.SIGKILL)
        await warm(pool)
        assert victim not in worker_pids()

    in_pool(test)


def test_work_beyond_the_deadline_is_stopped_and_its_worker_replaced() -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        before = worker_pids()
        with pytest.raises(DeadlineExceeded):
            await pool.answer(DOCUMENT, FILM)
        await warm(pool)
        assert len(before - worker_pids()) == 1

    in_new_pool(WorkerPool(Settings(workers=1, deadline_seconds=1)), test)


def test_a_scene_that_takes_too_much_memory_is_refused_and_its_worker_replaced(
    in_pool: Callable[[Test], None],
) -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        before = worker_pids()
        with pytest.raises(OutOfMemory, match=r"0\.5 GiB"):
            await pool.answer(wide_program(3000), RenderOptions())
        await warm(pool)
        assert not before & worker_pids()

    in_pool(test)


def test_a_full_line_turns_works_away_at_once_and_leaving_it_frees_a_place(
    in_pool: Callable[[Test], None],
) -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        busy = asyncio.create_task(pool.answer(LARGE, RenderOptions()))
        await asyncio.sleep(0)
        waiting = asyncio.create_task(pool.answer(DOCUMENT, LayoutOptions()))
        await asyncio.sleep(0)
        with pytest.raises(Overloaded):
            await pool.answer(DOCUMENT, LayoutOptions())
        waiting.cancel()
        await asyncio.wait({waiting})
        await pool.answer(DOCUMENT, LayoutOptions())
        assert busy.done()

    in_pool(test)


@pytest.mark.parametrize(
    ("line_seconds", "answered"), [(PATIENCE_SECONDS, 20), (1e-4, 1 + SHORT_LINE)]
)
def test_only_a_line_that_is_soon_done_may_grow_long(line_seconds: float, answered: int) -> None:
    async def test(pool: WorkerPool) -> None:
        await warm(pool)
        asked = [pool.answer(DOCUMENT, LayoutOptions()) for _ in range(20)]
        outcomes = await asyncio.gather(*asked, return_exceptions=True)
        assert sum(isinstance(each, Overloaded) for each in outcomes) == 20 - answered
        await pool.answer(DOCUMENT, LayoutOptions())

    in_new_pool(WorkerPool(Settings(workers=1), line_seconds=line_seconds), test)


def test_short_work_that_nobody_waits_for_ends_and_keeps_its_worker(
    in_pool: Callable[[Test], None],
) -> None:
    async def keeps(pool: WorkerPool) -> bool:
        await warm(pool)
        before = worker_pids()
        leaving = asyncio.create_task(pool.answer(DOCUMENT, RenderOptions()))
        await asyncio.sleep(0)
        leaving.cancel()
        await warm(pool)
        return worker_pids() == before

    async def test(pool: WorkerPool) -> None:
        # Half a second is short for a machine that has other things to do; not three times.
        for _ in range(3):
            if await keeps(pool):
                return
        pytest.fail("Work that takes a moment cost its worker.")

    in_pool(test)
