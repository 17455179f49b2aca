"""What is told faster than it is heard: the most recent of it waits."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

Told = TypeVar("Told")

MOST_WAITING = 16
"""Reports that wait for a listener."""


class Recent(Generic[Told]):
    """A queue for one listener that forgets the oldest where more than ``most`` would wait.

    Of those that are ``large`` only the latest waits.
    """

    def __init__(
        self, most: int = MOST_WAITING, large: Callable[[Told], bool] = lambda _told: False
    ) -> None:
        self._most, self._large = most, large
        self._waiting: deque[Told] = deque()
        self._news = asyncio.Event()

    def add(self, told: Told) -> None:
        """Put it at the end."""
        if self._large(told):
            self._waiting = deque(each for each in self._waiting if not self._large(each))
        if len(self._waiting) == self._most:
            self._waiting.popleft()
        self._waiting.append(told)
        self._news.set()

    async def get(self) -> Told:
        """Take the oldest; wait until there is one."""
        while not self._waiting:
            self._news.clear()
            await self._news.wait()
        return self._waiting.popleft()
