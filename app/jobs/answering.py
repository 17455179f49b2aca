"""Answers from memory or from the results kept, and from the workers where there are none yet.

What is asked several times at once is worked on once. The key of an answer is a digest of all that
it depends on: this code, the limits, the options, the document's bytes, and the layout's.
"""

from __future__ import annotations

import asyncio
import hashlib
from dataclasses import replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Self

import structlog

from app import __version__
from app.answers import Answer, LayoutOptions, Options, RenderOptions, Unchanged, is_known
from app.errors import StoreUnavailable
from app.jobs.executor import Finished, WorkerPool
from app.jobs.flights import Flights
from app.jobs.memory import LARGEST_SHARE, Kept, Memory, body_bytes
from app.jobs.process import Listener
from app.settings import Settings
from app.store.results import PIECE_BYTES, Result, Results

log = structlog.get_logger("tubeloom.jobs")

HASHED_AT_ONCE = 256 * 1024
"""Bytes that the event loop may hash itself; more would keep others waiting."""

STORING_BYTES = 64 * 1024 * 1024
"""Of answers on their way into the store, at most; those beyond it are not kept."""

LAYOUTS_SHARE = 4
"""Of the memory for answers, so large a part again is for layouts of posted documents."""

SLOW_SECONDS = 1.0
PAUSE_SECONDS = 30.0
"""A store that takes so long to have nothing is left alone for a while: askers should not wait for
it one after another."""


class Answering:
    """Stands before the pool of workers, and is asked in the same way.

    Use it as an asynchronous context manager, within those of ``pool`` and ``results``.
    """

    def __init__(self, pool: WorkerPool, results: Results, settings: Settings) -> None:
        self._pool, self._results = pool, results
        self._memory: Memory[Kept] = Memory(settings.memory_bytes, body_bytes)
        self._layouts: Memory[bytes] = Memory(settings.memory_bytes // LAYOUTS_SHARE, len)
        self._root = hashlib.sha256(f"{__version__}\n{code_digest()}\n{_limits(settings)}".encode())
        self._flights: Flights[Finished] = Flights()
        self._storing: set[asyncio.Task[None]] = set()
        self._storing_bytes = 0
        self._ask_again = 0.0
        self.hits = 0
        """Answers that were there already."""
        self.misses = 0
        """Answers that were worked out for whoever asked."""
        self.shared = 0
        """Answers that were being worked out already, for somebody else."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self._flights.close()
        await asyncio.gather(*self._storing)

    def key(self, document: bytes, options: Options, layout: bytes | None = None) -> str:
        """Of the answer: 64 hexadecimal digits. Equal keys have equal answers."""
        return self._keys(document, options, layout)[0]

    def _keys(
        self, document: bytes, options: Options, layout: bytes | None
    ) -> tuple[str, str | None]:
        """Of the answer, and of the document's layout, where other answers have it in common.

        Stored programs have layouts of their own, and conversions none. The document is hashed
        once.
        """
        content = hashlib.sha256(document).digest()
        of_answer = self._root.copy()
        of_answer.update(f"{_asked(options)}\n{layout is None}\n".encode())
        of_answer.update(content)
        of_answer.update(layout or b"")
        if layout is not None or not isinstance(options, RenderOptions | LayoutOptions):
            return of_answer.hexdigest(), None
        of_layout = self._root.copy()
        of_layout.update(f"{options.source}\n{options.wishes}\nlayout\n".encode())
        of_layout.update(content)
        return of_answer.hexdigest(), of_layout.hexdigest()

    def at_hand(
        self,
        document: bytes,
        options: Options,
        known: frozenset[str] = frozenset(),
        layout: bytes | None = None,
    ) -> Finished | None:
        """The answer, if it can be had without waiting for anything."""
        if _is_long(document, layout):
            return None
        return self._remembered(self.key(document, options, layout), known)

    async def answer(
        self,
        document: bytes,
        options: Options,
        known: frozenset[str] = frozenset(),
        listener: Listener | None = None,
        layout: bytes | None = None,
    ) -> Finished:
        """As `WorkerPool.answer`. Work stops when the last who asked for it is cancelled."""
        if isinstance(options, RenderOptions) and options.sweep:
            self.misses += 1
            finished = await self._pool.answer(document, options, known, listener, layout)
            return replace(finished, cache="miss")
        if _is_long(document, layout):
            key, layout_key = await asyncio.to_thread(self._keys, document, options, layout)
        else:
            key, layout_key = self._keys(document, options, layout)
        if (remembered := self._remembered(key, known)) is not None:
            return remembered

        async def find(tell: Listener) -> Finished:
            if (kept := await self._kept(key)) is not None:
                return _finished(kept, known)
            heard = None if listener is None else tell
            shared = None if layout_key is None else self._layouts.get(layout_key)
            finished = await self._pool.answer(document, options, known, heard, layout, shared)
            if layout_key is not None and finished.shared is not None:
                self._layouts.put(layout_key, finished.shared)
            self._keep(key, finished)
            return replace(finished, cache="miss", shared=None)

        # Work that nobody listens to makes no reports, and there are none of work that found that
        # its asker has the answer already.
        flight = (key, known, listener is not None)
        finished, is_joined = await self._flights.join(flight, find, listener)
        if finished.cache == "hit":
            self.hits += 1
        elif is_joined:
            self.shared += 1
            return replace(finished, cache="shared")
        else:
            self.misses += 1
        return finished

    def _remembered(self, key: str, known: frozenset[str]) -> Finished | None:
        """The answer, if it is in memory."""
        if (kept := self._memory.get(key)) is None:
            return None
        self._results.touch(key)
        self.hits += 1
        return _finished(kept, known)

    async def _kept(self, key: str) -> Kept | None:
        """The answer, if it is among the results."""
        clock = asyncio.get_running_loop().time
        if (began := clock()) < self._ask_again:
            return None
        if (result := await self._results.get(key)) is None:
            if clock() > began + SLOW_SECONDS:
                log.warning("results are slow and not asked for a while")
                self._ask_again = clock() + PAUSE_SECONDS
            return None
        notes = result.notes
        answer = Answer(b"", result.media_type, notes["etag"], notes["name"], notes["notes"])
        self._memory.put(key, (answer, result.pieces))
        return answer, result.pieces

    def _keep(self, key: str, finished: Finished) -> None:
        """Keep an answer that anybody would get who asked again."""
        answer = finished.answer
        if not isinstance(answer, Answer) or answer.etag is None:
            return
        size = sum(map(len, finished.pieces))
        # As many pieces as the answer came in would each be sent on its own, time and again.
        pieces = (b"".join(finished.pieces),) if size <= PIECE_BYTES else finished.pieces
        self._memory.put(key, (answer, pieces))
        if size * LARGEST_SHARE > self._results.most_bytes:
            return
        if self._storing and self._storing_bytes + size > STORING_BYTES:
            return
        result = Result(
            pieces,
            answer.media_type,
            {"etag": answer.etag, "name": answer.name, "notes": dict(answer.notes)},
        )
        self._storing_bytes += size
        storing = asyncio.create_task(self._store(key, result))
        self._storing.add(storing)
        storing.add_done_callback(partial(self._stored, size))

    async def _store(self, key: str, result: Result) -> None:
        try:
            await self._results.put(key, result.pieces, result.media_type, result.notes)
        except StoreUnavailable:
            log.warning("answer is not kept", key=key)

    def _stored(self, size: int, storing: asyncio.Task[None]) -> None:
        self._storing.discard(storing)
        self._storing_bytes -= size
        if not storing.cancelled() and (error := storing.exception()) is not None:
            log.error("answer is not kept", error=repr(error))


def code_digest() -> str:
    """Of all files but the pages: answers of other code may differ, though not its version."""
    package = Path(__file__).parents[1]
    rooms = (room for room in package.iterdir() if room.name != "web")
    digest = hashlib.sha256()
    for file in sorted(file for room in rooms for file in (room, *room.rglob("*"))):
        if file.is_file() and "__pycache__" not in file.parts:
            digest.update(f"{file.relative_to(package)}\n".encode())
            digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()


def _limits(settings: Settings) -> list[tuple[str, object]]:
    """What is refused elsewhere or at other times must not be answered from memory here."""
    names = (name for name in type(settings).model_fields if name.startswith("max_"))
    return [(name, getattr(settings, name)) for name in names]


def _asked(options: Options) -> str:
    """All that is asked, always in the same words."""
    if isinstance(options, RenderOptions) and options.delta is not None:
        return repr(options)  # which may be long, and is not asked often
    return _remembered_repr(options)


_remembered_repr = lru_cache(256)(repr)


def _is_long(document: bytes, layout: bytes | None) -> bool:
    return len(document) + len(layout or b"") > HASHED_AT_ONCE


def _finished(kept: Kept, known: frozenset[str]) -> Finished:
    answer, pieces = kept
    if answer.etag is not None and is_known(answer.etag, known):
        return Finished(Unchanged(answer.etag), (), 0.0, (), "hit")
    return Finished(answer, pieces, 0.0, (), "hit")
