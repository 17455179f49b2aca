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
