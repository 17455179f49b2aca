"""What is told faster than it is heard: the most recent of it waits."""

from __future__ import annotations

import asyncio
from typing import Generic, TypeVar

Told = TypeVar("Told")

MOST_WAITING = 16
"""Reports that wait for a listener; previews of pictures are among them."""


class Recent(Generic[Told]):
    """A queue that forgets the oldest where more than ``most`` would wait."""

    def __init__(self, most: int = MOST_WAITING) -> None:
        self._queue: asyncio.Queue[Told] = asyncio.Queue(most)

    def add(self, told: Told) -> None:
        """Put it at the end."""
        if self._queue.full():
            self._queue.get_nowait()
        self._queue.put_nowait(told)

    async def get(self) -> Told:
        """Take the oldest; wait until there is one."""
        return await self._queue.get()
