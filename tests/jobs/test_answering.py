"""Answers that are kept and shared, with real workers, a real folder and a real database."""

from __future__ import annotations

import asyncio
import json
import socket
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from contextlib import ExitStack, asynccontextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest

from app.answers import Answer, LayoutOptions, RenderOptions, Unchanged
from app.errors import InvalidDocument
from app.jobs.answering import Answering
from app.jobs.executor import Finished, WorkerPool
from app.jobs.process import Listener
from app.jobs.work import Report
from app.output.media import SceneFormat
from app.settings import Settings
from app.store.database import Database
from app.store.results import Results
from tests.service import SMALL, is_worker, large_program

LARGE = large_program(200)
GLB = RenderOptions()

Test = Callable[[WorkerPool], Coroutine[Any, Any, None]]


@pytest.fixture(scope="module")
def in_pool() -> Iterator[Callable[[Test], None]]:
    """Runs a test with a pool of one worker, which tests share."""
    pool = WorkerPool(Settings(workers=1, max_waiting=8))
    with asyncio.Runner() as runner:
        runner.run(pool.__aenter__())
        runner.run(warm(pool))
        yield lambda test: runner.run(test(pool))
        runner.run(pool.__aexit__())


async def warm(pool: WorkerPool) -> None:
    """Wait for the worker, which may have kernels to compile."""
    while not pool.warm:
        await asyncio.sleep(0.05)


async def busy(pool: WorkerPool) -> None:
    """Wait until the worker works."""
    while not pool.busy:
        await asyncio.sleep(0.01)


def worker_pids() -> set[int]:
    """The processes that work for this one."""
    return {child.pid for child in psutil.Process().children() if is_worker(child)}


def connections(server: socket.socket, left_open: ExitStack) -> int:
    """How many have connected since that was asked last. They hear nothing, not even an end."""
    count = 0
    server.setblocking(False)
    with suppress(BlockingIOError):
        while True:
            left_open.enter_context(server.accept()[0])
            count += 1
    return count


@asynccontextmanager
async def answering(folder: Path, pool: WorkerPool, **settings: Any) -> AsyncIterator[Answering]:
    """In front of the pool, with results in the folder."""
    database = Database(f"sqlite:///{folder / 'a.db'}")
    database.migrate()
    chosen = Settings(**settings)
    try:
        place = chosen.results or folder / "results"
        async with (
            Results(place, database, chosen.results_bytes) as results,
            Answering(pool, results, chosen) as found,
        ):
            yield found
    finally:
        database.close()


def named(name: str) -> bytes:
    """A small program of that name."""
    return json.dumps({**SMALL, "name": name}).encode()


def counts(found: Answering) -> tuple[int, int, int]:
    """How many hits, misses and shared answers there were."""
    return found.hits, found.misses, found.shared


def works_of(pool: WorkerPool) -> list[float]:
    """The seconds of works that workers do from now on."""
    seconds: list[float] = []
    pool.witness = lambda each, _stages: seconds.append(each)
    return seconds


def note_in(reports: list[Report]) -> Listener:
    """Notes what it hears."""
    return lambda report, _preview: reports.append(report)


def without_cache(finished: Finished) -> tuple[object, tuple[bytes, ...]]:
    """The answer, and its body."""
    return finished.answer, finished.pieces


def test_what_was_answered_is_answered_again_without_a_worker(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            works = works_of(pool)
            assert found.at_hand(named("a"), GLB) is None
            first = await found.answer(named("a"), GLB)
            second = await found.answer(named("a"), GLB)
            third = found.at_hand(named("a"), GLB)
            assert third is not None
            assert (first.cache, second.cache, third.cache) == ("miss", "hit", "hit")
            assert without_cache(first) == without_cache(second) == without_cache(third)
            assert counts(found) == (2, 1, 0)
            assert len(works) == 1
            other = await found.answer(named("a"), LayoutOptions())
            assert other.cache == "miss"

    in_pool(test)


def test_answers_outlive_the_service_and_do_not_need_memory(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            first = await found.answer(named("b"), GLB)
        async with answering(tmp_path, pool, memory_bytes=0) as found:
            for _ in range(2):
                assert found.at_hand(named("b"), GLB) is None
                again = await found.answer(named("b"), GLB)
                assert again.cache == "hit"
                assert again.answer == first.answer
                assert b"".join(again.pieces) == b"".join(first.pieces)
            assert counts(found) == (2, 0, 0)

    in_pool(test)


def test_who_has_the_answer_already_is_told_so(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            first = await found.answer(named("c"), GLB)
            etag = first.answer.etag
            assert etag
            works = works_of(pool)
            for known in ({etag}, {"x", etag}, {"*"}):
                again = await found.answer(named("c"), GLB, frozenset(known))
                assert again.answer == Unchanged(etag)
                assert again.pieces == ()
            assert isinstance((await found.answer(named("c"), GLB, frozenset("x"))).answer, Answer)
            assert not works
            # That a worker finds nothing to draw is no answer to keep.
            layout = await found.answer(named("c"), LayoutOptions(), frozenset({"*"}))
            assert isinstance(layout.answer, Unchanged)
            whole = await found.answer(named("c"), LayoutOptions())
            assert isinstance(whole.answer, Answer)
            assert whole.cache == "miss"

    in_pool(test)


def test_what_is_asked_at_the_same_time_is_worked_on_once(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            works = works_of(pool)
            answers = await asyncio.gather(*(found.answer(named("d"), GLB) for _ in range(50)))
            assert len(works) == 1
            assert len({b"".join(each.pieces) for each in answers}) == 1
            assert sorted(str(each.cache) for each in answers) == ["miss"] + 49 * ["shared"]
            assert counts(found) == (0, 1, 49)

    in_pool(test)


def test_an_asker_who_leaves_takes_the_answer_from_nobody_and_the_last_stops_the_work(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            await found.answer(named("warm"), GLB)
            works, lost = works_of(pool), pool.lost
            askers = [asyncio.create_task(found.answer(LARGE, GLB)) for _ in range(3)]
            await busy(pool)
            askers[0].cancel()
            askers[2].cancel()
            stays = await askers[1]
            assert isinstance(stays.answer, Answer)
            assert len(works) == 1
            film = RenderOptions(SceneFormat.MP4, width=320, height=240, frames=1000)
            leaving = [asyncio.create_task(found.answer(LARGE, film)) for _ in range(2)]
            await busy(pool)
            stopped = worker_pids()
            for asker in leaving:
                asker.cancel()
            await asyncio.wait(leaving)
            await found.answer(named("e"), GLB)
            assert not stopped & worker_pids()
            assert pool.lost == lost

    in_pool(test)


def test_errors_are_shared_but_not_kept(in_pool: Callable[[Test], None], tmp_path: Path) -> None:
    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            works = works_of(pool)
            for count in (1, 2):
                outcomes = await asyncio.gather(
                    *(found.answer(b'{"items": 1}', GLB) for _ in range(3)), return_exceptions=True
                )
                assert all(isinstance(each, InvalidDocument) for each in outcomes)
                assert len(works) == count

    in_pool(test)


def test_answers_without_a_validator_sweeps_and_too_large_ones_are_not_kept(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        sweep = RenderOptions(SceneFormat.PNG, width=64, height=48, sweep=("/style/halo=0,0.3",))
        async with answering(tmp_path, pool, results_bytes=4000, memory_bytes=4000) as found:
            for document, options in ((named("f"), sweep), (named("f"), GLB)):
                for _ in range(2):
                    assert (await found.answer(document, options)).cache == "miss"
        assert not list((tmp_path / "results").rglob("*.*"))

    in_pool(test)


def test_a_listener_hears_how_work_goes_on_that_another_began(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        heard: list[list[Report]] = [[], []]
        document = large_program(200)
        async with answering(tmp_path, pool) as found:
            works = works_of(pool)
            await asyncio.gather(
                *(found.answer(document, GLB, listener=note_in(mine)) for mine in heard)
            )
            assert len(works) == 1
            assert heard[0] == heard[1]
            assert len(heard[0]) > 1

    in_pool(test)


def test_other_limits_and_other_layouts_are_other_questions(
    in_pool: Callable[[Test], None], tmp_path: Path
) -> None:
    async def test(pool: WorkerPool) -> None:
        async with (
            answering(tmp_path, pool) as one,
            answering(tmp_path, pool, max_items=2) as strict,
        ):
            keys = {
                one.key(b"ab", GLB),
                one.key(b"a", GLB, b"b"),
                one.key(b"ab", GLB, b""),
                one.key(b"ab", LayoutOptions()),
                strict.key(b"ab", GLB),
            }
            assert len(keys) == 5

    in_pool(test)


def test_a_store_that_does_not_answer_is_waited_for_once(
    in_pool: Callable[[Test], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY", "AWS_DEFAULT_REGION"):
        monkeypatch.setenv(name, "a")
    monkeypatch.setenv("AWS_ALLOW_HTTP", "true")

    async def test(pool: WorkerPool) -> None:
        async with answering(tmp_path, pool) as found:
            for name in "gh":
                await found.answer(named(name), GLB)
        with socket.create_server(("127.0.0.1", 0)) as silent, ExitStack() as left_open:
            monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{silent.getsockname()[1]}")
            async with answering(tmp_path, pool, results="s3://bucket", results_bytes=0) as found:
                assert (await found.answer(named("g"), GLB)).cache == "miss"
                assert connections(silent, left_open) > 0
                assert (await found.answer(named("h"), GLB)).cache == "miss"
                assert connections(silent, left_open) == 0

    in_pool(test)
