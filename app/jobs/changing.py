"""Changes of stored programs: loaded, revised by a worker, and stored, or nothing at all."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Literal, Self, TypeAlias

from app.answers import Change, Restoration
from app.errors import NothingToUndo, NotStored, Outdated, Overloaded, StoreFull
from app.jobs.executor import WorkerPool
from app.settings import Settings
from app.store import programs, requests
from app.store.database import Connection, Database
from app.store.records import Cause, Content, Head, Record
from app.store.requests import Reply

ATTEMPTS = 20
"""So often may others be first."""

Way: TypeAlias = Literal["undo", "redo"]
Wanted: TypeAlias = Change | Way | Literal["delete"]


@dataclass(frozen=True, slots=True)
class Wish:
    """What somebody wants to become of a program.

    ``check`` raises where the newest revision (``None``: there is no program) is not one that may
    be changed. ``reply`` makes an answer of the newest revision, and of whether
    the program is new; with a ``request`` that says who asked what, it is
    answered again to whoever asks the same again, and nothing more is done.
    What ``amends`` is one change to undo with the edit before, if there was one.
    """

    program: str
    wanted: Wanted
    cause: Cause
    check: Callable[[Record | None], None]
    reply: Callable[[Record, bool], Reply]
    request: str | None = None
    amends: bool = False


@dataclass(slots=True)
class _Turn:
    lock: asyncio.Lock = field(default_factory=asyncio.Lock)
    waiting: int = 0


class Changer:
    """Changes stored programs, one change of each at a time; ``listener`` hears of revisions."""

    def __init__(self, database: Database, pool: WorkerPool, settings: Settings) -> None:
        self._database, self._pool, self._settings = database, pool, settings
        self._turns: dict[str, _Turn] = {}
        self.listener: Callable[[Record], None] = _unheard

    async def change(self, wish: Wish) -> Reply:
        """Do what is wished for, once.

        Raises what ``wish.check`` does, what the pipeline does, `NotStored`, `NothingToUndo`,
        `StoreFull`, `Overloaded`, `StoreUnavailable`.
        """
        async with self._turn(wish.program):
            for _ in range(ATTEMPTS):
                try:
                    return await self._attempt(wish)
                except Outdated:
                    continue
        raise Overloaded("Others changed this program again and again; try again soon.")

    @asynccontextmanager
    async def _turn(self, program: str) -> AsyncIterator[None]:
        """Wait for others who change the same program: all but one of them would work in vain."""
        turn = self._turns.setdefault(program, _Turn())
        if turn.waiting > self._settings.max_waiting:
            raise Overloaded("Too many changes of this program wait already; try again soon.")
        turn.waiting += 1
        try:
            async with turn.lock:
                yield
        finally:
            turn.waiting -= 1
            if not turn.waiting:
                self._turns.pop(program, None)

    async def _attempt(self, wish: Wish) -> Reply:
        state = await self._database.read(lambda connection: _State.load(connection, wish))
        if state.reply is not None:
            return state.reply
        wish.check(None if state.content is None else state.content.record)
        if wish.wanted == "delete":
            return await self._delete(wish, state)
        if state.content is None:
            if wish.cause != "put":
                raise NotStored(f"There is no program {wish.program}.")
            if state.programs >= self._settings.max_programs:
                raise StoreFull(
                    f"There are {state.programs} programs already, as many as this service takes."
                )
        return await self._revise(wish, state, _plan(wish.wanted, wish.amends, state))

    async def _revise(self, wish: Wish, state: _State, plan: _Plan) -> Reply:
        content = state.content
        revised = await self._pool.revise(
            b"" if content is None else content.document,
            None if content is None else content.layout,
            plan.change,
        )
        if content is not None and not plan.is_step and revised.digest == content.record.digest:
            return await self._unchanged(wish, content.record)
        at = time.time_ns() // 1_000_000

        def commit(connection: Connection) -> tuple[Record, Reply]:
            record = programs.add(
                connection,
                wish.program,
                state.head,
                wish.cause,
                revised,
                undo_to=plan.undo_to,
                redo_to=plan.redo_to,
                keep=self._settings.kept_revisions,
                at=at,
            )
            return record, _keep_reply(connection, wish, record, is_new=content is None)

        return await self._commit(commit)

    async def _delete(self, wish: Wish, state: _State) -> Reply:
        if state.content is None or state.head is None:
            raise NotStored(f"There is no program {wish.program}.")
        head, at = state.head, time.time_ns() // 1_000_000

        def commit(connection: Connection) -> tuple[Record, Reply]:
            record = programs.end(connection, wish.program, head, at)
            return record, _keep_reply(connection, wish, record)

        return await self._commit(commit)

    async def _unchanged(self, wish: Wish, record: Record) -> Reply:
        """What makes no difference makes no revision."""
        if wish.request is None:
            return wish.reply(record, False)
        return await self._database.write(lambda connection: _keep_reply(connection, wish, record))

    async def _commit(self, commit: Callable[[Connection], tuple[Record, Reply]]) -> Reply:
        # Whoever is cancelled while it is stored must not leave a revision that nobody hears of.
        return await asyncio.shield(asyncio.ensure_future(self._stored(commit)))

    async def _stored(self, commit: Callable[[Connection], tuple[Record, Reply]]) -> Reply:
        record, reply = await self._database.write(commit)
        self.listener(record)
        return reply


@dataclass(frozen=True, slots=True)
class _State:
    """What there is before a change; ``target`` is where an undo or redo leads, if it is kept."""

    reply: Reply | None
    head: Head | None = None
    content: Content | None = None
    target: Content | None = None
    programs: int = 0

    @classmethod
    def load(cls, connection: Connection, wish: Wish) -> Self:
        if wish.request is not None:
            reply = requests.find(connection, wish.request)
            if reply is not None:
                return cls(reply)
        head = programs.head(connection, wish.program)
        content = programs.load(connection, wish.program)
        if content is None:
            return cls(None, head, programs=programs.count(connection))
        number = _aim(wish.wanted, content.record)
        target = None if number is None else programs.load(connection, wish.program, number)
        return cls(None, head, content, target)


@dataclass(frozen=True, slots=True)
class _Plan:
    """What is done to a program, and where an undo and a redo of it lead."""

    change: Change
    undo_to: int | None
    redo_to: int | None = None
    is_step: bool = False


def _plan(wanted: Change | Way, amends: bool, state: _State) -> _Plan:
    """Raises `NothingToUndo`."""
    newest = None if state.content is None else state.content.record
    if not isinstance(wanted, str):
        if newest is None:
            return _Plan(wanted, None)
        is_one = amends and newest.cause == "edit"
        return _Plan(wanted, newest.undo_to if is_one else newest.number)
    if newest is None or _aim(wanted, newest) is None:
        raise NothingToUndo(
            "There is no change to take back."
            if wanted == "undo"
            else "No change was taken back that could be made again."
        )
    if state.target is None:
        raise NothingToUndo("The revision that this would restore is not kept any more.")
    target = state.target.record
    change = Restoration(state.target.document, state.target.layout)
    redo_to = newest.number if wanted == "undo" else target.redo_to
    return _Plan(change, target.undo_to, redo_to, is_step=True)


def _aim(wanted: Wanted, newest: Record) -> int | None:
    """The number of the revision that an undo or redo restores."""
    match wanted:
        case "undo":
            return newest.undo_to
        case "redo":
            return newest.redo_to
        case _:
            return None


def _keep_reply(
    connection: Connection, wish: Wish, record: Record, *, is_new: bool = False
) -> Reply:
    reply = wish.reply(record, is_new)
    if wish.request is not None:
        requests.keep(connection, wish.request, reply)
    return reply


def _unheard(_record: Record) -> None:
    """Where nobody wants to know."""
