"""Work for several askers at once: it goes on as long as one of them is there."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Hashable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from app.jobs.process import Listener
from app.jobs.work import Report

Found = TypeVar("Found")


@dataclass(slots=True)
class _Flight(Generic[Found]):
    work: asyncio.Task[Found]
    listeners: list[Listener]
    askers: int = 0


@dataclass(slots=True)
class Flights(Generic[Found]):
    """Works under way, by what tells whether two of them would be the same."""

    _under_way: dict[Hashable, _Flight[Found]] = field(default_factory=dict)

    async def join(
        self,
        key: Hashable,
        work: Callable[[Listener], Awaitable[Found]],
        listener: Listener | None = None,
    ) -> tuple[Found, bool]:
        """What the ``work`` of this key finds, and whether somebody else had begun it.

        It is begun unless it is under way, in the context of whoever comes first, and stops when
        the last asker is cancelled. Every ``listener`` hears what is reported while it is there.
        """
        flight = self._under_way.get(key)
        is_joined = flight is not None
        if flight is None:
            flight = self._begin(key, work)
        flight.askers += 1
        if listener is not None:
            flight.listeners.append(listener)
        try:
            await asyncio.wait({flight.work})
        except asyncio.CancelledError:
            flight.askers -= 1
            if listener is not None:
                flight.listeners.remove(listener)
            if not flight.askers:
                self._end(key, flight)
                flight.work.cancel()
            raise
        return flight.work.result(), is_joined

    async def close(self) -> None:
        """Stop all works, and wait until they have stopped."""
        works = [flight.work for flight in self._under_way.values()]
        for work in works:
            work.cancel()
        await asyncio.gather(*works, return_exceptions=True)

    def _begin(self, key: Hashable, work: Callable[[Listener], Awaitable[Found]]) -> _Flight[Found]:
        listeners: list[Listener] = []

        def tell(report: Report, preview: bytes) -> None:
            for listener in listeners:
                listener(report, preview)

        async def do() -> Found:
            return await work(tell)

        flight = _Flight(asyncio.create_task(do()), listeners)
        self._under_way[key] = flight

        def landed(work: asyncio.Task[Found]) -> None:
            self._end(key, flight)
            if not work.cancelled():
                work.exception()  # which nobody may be there to hear of

        flight.work.add_done_callback(landed)
        return flight

    def _end(self, key: Hashable, flight: _Flight[Found]) -> None:
        """Whoever comes now begins anew."""
        if self._under_way.get(key) is flight:
            del self._under_way[key]
