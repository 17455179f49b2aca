"""News of stored programs for everybody who watches them, each revision in its turn.

A revision is made an event once, however many watch. What is recent is kept here; whoever was away
for longer gets it from the database, and whoever was away for too long hears of that.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from typing import Self

import structlog
from fastapi.sse import format_sse_event

from app.api.revision_model import RevisionModel
from app.errors import NotStored, Overloaded, StoreUnavailable
from app.settings import Settings
from app.store import programs
from app.store.database import Database
from app.store.records import Record

log = structlog.get_logger("tubeloom.feed")

RECENT = 256
"""Events of each watched program that are kept in memory."""

BEAT_SECONDS = 10.0
"""After which a comment says that there is still somebody here: proxies close what is silent."""

RETRY_MILLISECONDS = 1000
"""After which a browser whose connection breaks comes back."""


@dataclass(slots=True)
class Topic:
    """A program that somebody watches, and its newest events, each with its number."""

    number: int
    events: deque[tuple[int, bytes]] = field(default_factory=lambda: deque(maxlen=RECENT))
    news: asyncio.Event = field(default_factory=asyncio.Event)
    watchers: int = 0

    def add(self, record: Record) -> None:
        """Tell of a revision, unless it is known already."""
        if record.number <= self.number:
            return
        if record.number > self.number + 1:
            self.events.clear()  # those between are in the database
        self.number = record.number
        self.events.append((record.number, event_of(record)))
        self.wake()

    def wake(self) -> None:
        """Let everybody look."""
        self.news.set()
        self.news = asyncio.Event()

    def after(self, number: int) -> list[tuple[int, bytes]] | None:
        """The events that follow ``number``; ``None`` where not all of them are here."""
        missing = self.number - number
        if missing > len(self.events):
            return None
        return list(islice(self.events, len(self.events) - missing, None))


class Feed:
    """Watchers of programs. Use it as an asynchronous context manager."""

    def __init__(self, database: Database, settings: Settings) -> None:
        self._database, self._settings = database, settings
        self._topics: dict[str, Topic] = {}
        self._tasks: list[asyncio.Task[None]] = []
        self._is_ending = False

    @property
    def watchers(self) -> int:
        """How many watch."""
        return sum(topic.watchers for topic in self._topics.values())

    async def __aenter__(self) -> Self:
        self._tasks = [asyncio.create_task(self._look()), asyncio.create_task(self._beat())]
        return self

    async def __aexit__(self, *_: object) -> None:
        self.end()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def end(self) -> None:
        """Let all watchers go: the service ends, and they may come back to another one."""
        self._is_ending = True
        for topic in self._topics.values():
            topic.wake()

    def tell(self, record: Record) -> None:
        """Tell of a revision that has been stored."""
        topic = self._topics.get(record.program)
        if topic is not None:
            topic.add(record)

    async def watch(self, program: str, after: int | None) -> AsyncIterator[bytes]:
        """Events from the revision that follows ``after`` on, or from now.

        Raises `NotStored`, `Overloaded`, `StoreUnavailable`; the iterator, once there, ends with
        the program.
        """
        if self.watchers >= self._settings.max_watchers:
            raise Overloaded(f"{self.watchers} watch already; try again later.")
        head = await self._database.read(partial(programs.head, program=program))
        if head is None or (head.is_deleted and (after is None or after >= head.revision)):
            raise NotStored(f"There is no program {program}.")
        return self._events(program, head.revision, after)

    async def _events(self, program: str, newest: int, after: int | None) -> AsyncIterator[bytes]:
        topic = self._topics.setdefault(program, Topic(newest))
        topic.watchers += 1
        try:
            start = topic.number if after is None else after
            yield f"retry: {RETRY_MILLISECONDS}\n\n".encode()
            if after is None or after > topic.number:
                start = topic.number
                yield _note("current" if after is None else "reset", start)
            async for piece in self._from(program, topic, start):
                yield piece
        except StoreUnavailable:
            return  # the watcher comes back by itself, and misses nothing
        finally:
            topic.watchers -= 1
            if not topic.watchers and self._topics.get(program) is topic:
                del self._topics[program]

    async def _from(self, program: str, topic: Topic, number: int) -> AsyncIterator[bytes]:
        while not self._is_ending:
            events = topic.after(number)
            if events is None:
                records = await self._database.read(
                    partial(programs.kept_after, program=program, number=number)
                )
                events = [(record.number, event_of(record)) for record in records]
                if events and len(events) < events[-1][0] - number:
                    newest = records[-1]
                    if newest.cause != "delete":
                        events = [(newest.number, _note("reset", newest.number))]
            if events:
                number = events[-1][0]
                for _, event in events:
                    yield event
                if events[-1][1].startswith(_DELETED):
                    return
                continue
            await topic.news.wait()
            if topic.number == number:
                yield format_sse_event(comment="still here")

    async def _look(self) -> None:
        """See now and then whether other services that share the database have made revisions."""
        while True:
            await asyncio.sleep(self._settings.look_seconds)
            if not self._topics:
                continue
            try:
                await self._look_once()
            except StoreUnavailable:
                log.warning("cannot look for revisions: the database does not answer")

    async def _look_once(self) -> None:
        heads = await self._database.read(partial(programs.heads, names=tuple(self._topics)))
        for program, number in heads.items():
            topic = self._topics.get(program)
            if topic is None or topic.number >= number:
                continue
            records = await self._database.read(
                partial(programs.kept_after, program=program, number=topic.number)
            )
            for record in records:
                topic.add(record)

    async def _beat(self) -> None:
        while True:
            await asyncio.sleep(BEAT_SECONDS)
            for topic in self._topics.values():
                topic.wake()


def event_of(record: Record) -> bytes:
    """A revision as an event."""
    if record.cause == "delete":
        return _note("deleted", record.number)
    return format_sse_event(
        event="revision",
        data_str=RevisionModel.of(record).model_dump_json(),
        id=str(record.number),
    )


def _note(event: str, number: int) -> bytes:
    return format_sse_event(event=event, data_str=f'{{"revision":{number}}}', id=str(number))


_DELETED = b"event: deleted\n"
