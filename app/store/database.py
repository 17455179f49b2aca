"""The database: SQLite in a file of its own, or PostgreSQL by its URL.

Work is a function of a connection. It is done in a thread, in one transaction, and may be tried
again from the start; so it must do nothing else that counts.
"""

from __future__ import annotations

import asyncio
import sqlite3
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import sqlalchemy
import structlog
from sqlalchemy import create_engine, event
from sqlalchemy.engine import URL, Engine, make_url
from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError

from app.errors import StoreUnavailable

log = structlog.get_logger("tubeloom.store")

Connection: TypeAlias = sqlalchemy.Connection

Found = TypeVar("Found")

THREADS = 4
"""As many transactions at a time, and as many connections."""

BUSY_SECONDS = 10.0
"""How long a writer of SQLite waits for the others."""

ATTEMPTS = 4
PAUSE_SECONDS = 0.15
"""Before the second attempt; each further pause is twice as long."""

PASSING = frozenset({"40001", "40P01", "53300", "57P01", "57P02", "57P03"})
"""PostgreSQL's codes for what trying again mends: serialization failures and deadlocks, too many
connections, a server that stops, has crashed, or is about to start."""


class Database:
    """A database and the threads that speak to it. `migrate` comes first."""

    def __init__(self, url: str) -> None:
        self.url = _with_driver(make_url(url))
        self.is_sqlite = self.url.get_backend_name() == "sqlite"
        self._engine = _engine(self.url)
        self._threads = ThreadPoolExecutor(THREADS, "database")

    def migrate(self) -> None:
        """Bring the tables to their newest form. Raises `StoreUnavailable`."""
        from app.store.migrating import upgrade

        if self.is_sqlite and self.url.database:
            Path(self.url.database).parent.mkdir(parents=True, exist_ok=True)
        self.do(upgrade)

    async def read(self, work: Callable[[Connection], Found]) -> Found:
        """What ``work``, which changes nothing, finds. Raises `StoreUnavailable`."""
        return await self._in_thread(work, writes=False)

    async def write(self, work: Callable[[Connection], Found]) -> Found:
        """Do ``work`` and commit it. Raises `StoreUnavailable`, and then nothing is promised."""
        return await self._in_thread(work, writes=True)

    def do(self, work: Callable[[Connection], Found], *, writes: bool = True) -> Found:
        """The same in this thread, for the command line and for starting."""
        pause = PAUSE_SECONDS
        for attempt in range(1, ATTEMPTS + 1):
            try:
                return self._once(work, writes=writes)
            except DBAPIError as error:
                if not _may_pass(error):
                    raise
                if attempt == ATTEMPTS:
                    log.warning("database unavailable", error=str(error.orig))
                    raise StoreUnavailable("The database does not answer; try again soon.") from (
                        error
                    )
            time.sleep(pause)
            pause *= 2
        raise AssertionError("the last attempt returns or raises")

    def close(self) -> None:
        """Let running transactions end, and close all connections."""
        self._threads.shutdown()
        self._engine.dispose()

    async def _in_thread(self, work: Callable[[Connection], Found], *, writes: bool) -> Found:
        loop = asyncio.get_running_loop()
        return await loop.run_in_executor(self._threads, lambda: self.do(work, writes=writes))

    def _once(self, work: Callable[[Connection], Found], *, writes: bool) -> Found:
        with self._engine.connect() as connection:
            # SQLite would otherwise lock at the first change, too late to wait for other writers.
            connection.info["begin"] = "BEGIN IMMEDIATE" if writes else "BEGIN"
            with connection.begin():
                return work(connection)


def _with_driver(url: URL) -> URL:
    backend = url.get_backend_name()
    if backend == "postgresql":
        return url.set(drivername="postgresql+pg8000")
    if backend == "sqlite":
        return url.set(drivername="sqlite+pysqlite")
    raise ValueError(f"Say sqlite:///… or postgresql://…, not {backend}.")


def _engine(url: URL) -> Engine:
    if url.get_backend_name() == "postgresql":
        return create_engine(
            url,
            pool_size=THREADS,
            max_overflow=0,
            pool_pre_ping=True,
            connect_args={"timeout": BUSY_SECONDS},
        )
    engine = create_engine(
        url, pool_size=THREADS, max_overflow=0, connect_args={"timeout": BUSY_SECONDS}
    )

    @event.listens_for(engine, "connect")
    def prepare(connection: sqlite3.Connection, _record: Any) -> None:
        connection.isolation_level = None  # we say when transactions begin
        connection.execute("PRAGMA journal_mode=WAL")
        # A commit is on the disk when it is acknowledged, even if the power fails then.
        connection.execute("PRAGMA synchronous=FULL")
        connection.execute("PRAGMA foreign_keys=ON")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql(connection.info.get("begin", "BEGIN"))

    return engine


def _may_pass(error: DBAPIError) -> bool:
    """Whether another attempt may succeed: the connection was lost, or others were in the way."""
    if error.connection_invalidated or isinstance(error, OperationalError | InterfaceError):
        return True
    details = error.orig.args[0] if error.orig is not None and error.orig.args else None
    return isinstance(details, dict) and details.get("C") in PASSING
