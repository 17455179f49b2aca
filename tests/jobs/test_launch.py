"""Worker processes that start before there is a service."""

from __future__ import annotations

import asyncio
import json

import psutil

from app.answers import LayoutOptions
from app.jobs.executor import WorkerPool
from app.jobs.launch import launched
from app.settings import Settings
from tests.service import SMALL


def test_a_process_that_nobody_took_ends() -> None:
    with launched(2) as processes:
        taken = processes.pop()
        (left,) = processes
    assert left.process.returncode is not None
    assert taken.process.poll() is None
    taken.drop()
    assert taken.process.returncode is not None


def test_a_pool_takes_those_that_are_there() -> None:
    async def ask(pool: WorkerPool) -> set[int]:
        async with pool:
            await pool.answer(json.dumps(SMALL).encode(), LayoutOptions())
            return {
                child.pid
                for child in psutil.Process().children()
                if "app.jobs.worker" in child.cmdline()
            }

    with launched(1) as processes:
        expected = {each.process.pid for each in processes}
        found = asyncio.run(ask(WorkerPool(Settings(workers=1), launched=processes)))
        assert processes == []
    assert found == expected
