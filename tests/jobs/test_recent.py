from __future__ import annotations

import asyncio

from app.jobs.recent import Recent


def test_the_oldest_is_forgotten_where_nobody_listens() -> None:
    async def told() -> list[int]:
        recent: Recent[int] = Recent(3)
        for number in range(10):
            recent.add(number)
        return [await recent.get() for _ in range(3)]

    assert asyncio.run(told()) == [7, 8, 9]


def test_of_what_is_large_only_the_latest_waits() -> None:
    async def told() -> list[int]:
        recent: Recent[int] = Recent(4, large=lambda number: number >= 100)
        for number in (1, 100, 2, 101, 3, 102):
            recent.add(number)
        return [await recent.get() for _ in range(4)]

    assert asyncio.run(told()) == [1, 2, 3, 102]


def test_who_listens_is_told_at_once() -> None:
    async def told() -> list[int]:
        recent: Recent[int] = Recent()
        heard = asyncio.gather(*(recent.get() for _ in range(1)))
        await asyncio.sleep(0)
        recent.add(1)
        return await heard

    assert asyncio.run(told()) == [1]
