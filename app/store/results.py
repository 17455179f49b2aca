"""Results: finished answers in a folder or in object storage, kept within bounds.

The bytes are objects; the table ``results`` knows of each what it is, how large, and when it was
used last. An object is named after its key and the digest of its bytes, so that what a row tells
of is there as a whole or not at all. An object without a row, which a crash may leave, goes at the
next start; a row without its object is a miss.
"""

from __future__ import annotations

import asyncio
import hashlib
import json
import re
import time
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import structlog
from sqlalchemy import Connection, Row, delete, select, update

from app.errors import StoreUnavailable
from app.store.database import Database
from app.store.objects import Objects
from app.store.result_rows import Gone, digest_in, note
from app.store.tables import results

log = structlog.get_logger("tubeloom.store")

_KEY = re.compile(r"[0-9a-f]{64}")

PIECE_BYTES = 4 * 1024 * 1024
"""Bodies are handed out in pieces of at most so many bytes, which a network takes one by one."""

FLUSH_SECONDS = 30.0
"""When results were used is written down so often; a crash forgets no more."""

ORPHAN_SECONDS = 300.0
"""An object that is younger may be another service's, which is about to write its row."""


@dataclass(frozen=True, slots=True)
class Result:
    """Bytes in pieces, what they are, and what else is to be said of them."""

    pieces: tuple[bytes, ...]
    media_type: str
    notes: Mapping[str, Any]

    @property
    def size(self) -> int:
        """In bytes."""
        return sum(map(len, self.pieces))


class Results:
    """Results by their keys, which are 64 hexadecimal digits.

    Over ``most_bytes`` those go that were used the longest ago. Use it as an asynchronous context
    manager, with a database whose tables are there.
    """

    def __init__(self, place: str | Path, database: Database, most_bytes: int) -> None:
        """``place`` is a folder or the URL of one, or of object storage. Raises `ValueError`."""
        self.most_bytes = most_bytes
        self._objects = Objects(place)
        self._database = database
        self._rows: dict[str, dict[str, Any]] = {}
        self._used: dict[str, int] = {}
        self._added = most_bytes
        self._flushing = asyncio.Lock()
        self._tending: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        self._tending = asyncio.create_task(self._tend())
        return self

    async def __aexit__(self, *_: object) -> None:
        if self._tending is not None:
            self._tending.cancel()
            with suppress(asyncio.CancelledError):
                await self._tending
        try:
            await self._flush()
        except StoreUnavailable:
            log.warning("uses of results are forgotten")

    async def get(self, key: str) -> Result | None:
        """The result, or ``None`` where it is not there, not whole, or cannot be had now."""
        _check(key)
        try:
            row = await self._database.read(lambda connection: _find(connection, key))
            if row is None:
                return None
            said = json.loads(row.notes)
            path = _path(key, said["digest"])
            body = await self._objects.get(path)
        except StoreUnavailable:
            return None
        if body is None:
            await self._forget(row, path)
            return None
        pieces = await asyncio.to_thread(_whole, body, said["digest"])
        if pieces is None:
            log.warning("result is broken", key=key)
            await self._forget(row, path)
            return None
        self.touch(key)
        return Result(pieces, row.media_type, said["notes"])

    async def put(
        self,
        key: str,
        pieces: Sequence[bytes],
        media_type: str,
        notes: Mapping[str, Any],
        kept_until: int = 0,
    ) -> None:
        """Keep a result: until ``kept_until`` (ms since 1970) for sure, then while it fits.

        It is kept when this returns. One that is too large for the store and has no ``kept_until``
        is not kept at all. Raises `StoreUnavailable`.
        """
        _check(key)
        size = sum(map(len, pieces))
        if size > self.most_bytes and not kept_until:
            return
        digest = await asyncio.to_thread(_digest, pieces)
        await self._objects.put(_path(key, digest), pieces)
        now = _now()
        self._rows[key] = {
            "key": key,
            "media_type": media_type,
            "notes": json.dumps({"digest": digest, "notes": dict(notes)}, ensure_ascii=False),
            "size": size,
            "created_at": now,
            "used_at": now,
            "kept_until": kept_until,
        }
        try:
            await self._flush()
        except StoreUnavailable:
            self._rows.pop(key, None)
            raise

    async def keep(self, key: str, until: int) -> bool:
        """Keep what is there until then (ms since 1970). False where it is not there.

        Raises `StoreUnavailable`.
        """
        _check(key)

        def work(connection: Connection) -> bool:
            if (row := _find(connection, key)) is None:
                return False
            kept_until = max(row.kept_until, until)
            connection.execute(
                update(results).where(results.c.key == key).values(kept_until=kept_until)
            )
            return True

        return await self._database.write(work)

    def touch(self, key: str) -> None:
        """Note that a result was used just now, by whoever had it at hand."""
        self._used[key] = _now()

    async def clean(self) -> None:
        """Delete objects without a row, and rows without an object. Raises `StoreUnavailable`."""
        oldest = time.time() - ORPHAN_SECONDS
        there = await self._objects.times()
        await self._objects.delete_unfinished(ORPHAN_SECONDS)
        rows = await self._database.read(
            lambda connection: connection.execute(
                select(results.c.key, results.c.notes, results.c.created_at)
            ).all()
        )
        known = {_path(row.key, digest_in(row.notes)): row for row in rows}
        lost = [
            row.key
            for path, row in known.items()
            if path not in there and row.created_at < oldest * 1000
        ]
        orphans = [path for path, at in there.items() if path not in known and at < oldest]
        if lost:
            await self._database.write(
                lambda connection: [
                    connection.execute(delete(results).where(results.c.key == key)) for key in lost
                ]
            )
        await self._objects.delete(orphans)
        if lost or orphans:
            log.info("results cleaned", lost=len(lost), orphans=len(orphans))

    async def _tend(self) -> None:
        try:
            await self.clean()
        except StoreUnavailable as error:
            log.warning("results are not cleaned", error=str(error))
        while True:
            await asyncio.sleep(FLUSH_SECONDS)
            try:
                await self._flush()
            except StoreUnavailable:
                continue  # which says so itself; the next time may do
            except Exception:
                log.exception("unexpected error")

    async def _flush(self) -> None:
        """Write down all that is new. Those who come meanwhile are written together, thereafter."""
        async with self._flushing:
            if not (self._rows or self._used):
                return
            rows, self._rows = self._rows, {}
            used, self._used = self._used, {}
            self._added += sum(row["size"] for row in rows.values())
            # So that the sum over all rows, others' too, is not made for every small one.
            slack = self.most_bytes // 16
            limit = self.most_bytes - slack if self._added > slack else None
            try:
                gone: Gone = await self._database.write(
                    lambda connection: note(connection, list(rows.values()), used, limit, _now())
                )
            except BaseException:
                self._rows, self._used = {**rows, **self._rows}, {**used, **self._used}
                raise
            if limit is not None:
                self._added = 0
            await self._objects.delete(_path(key, digest) for key, digest in gone)

    async def _forget(self, row: Row[Any], path: str) -> None:
        """Delete a row that tells of what is not there, and what is there instead."""
        same = (results.c.key == row.key) & (results.c.notes == row.notes)
        with suppress(StoreUnavailable):
            await self._database.write(
                lambda connection: connection.execute(delete(results).where(same))
            )
        await self._objects.delete([path])


def _check(key: str) -> None:
    if not _KEY.fullmatch(key):
        raise ValueError(f"The key of a result is 64 hexadecimal digits, not {key!r}.")


def _find(connection: Connection, key: str) -> Row[Any] | None:
    return connection.execute(select(results).where(results.c.key == key)).one_or_none()


def _path(key: str, digest: str) -> str:
    return f"{key[:2]}/{key}.{digest}"


def _digest(pieces: Iterable[bytes]) -> str:
    digest = hashlib.blake2b(digest_size=16)
    for piece in pieces:
        digest.update(piece)
    return digest.hexdigest()


def _whole(body: memoryview, digest: str) -> tuple[bytes, ...] | None:
    """A body in pieces, if it is the one with this digest."""
    if hashlib.blake2b(body, digest_size=16).hexdigest() != digest:
        return None
    return tuple(
        bytes(body[start : start + PIECE_BYTES]) for start in range(0, len(body), PIECE_BYTES)
    )


def _now() -> int:
    return time.time_ns() // 1_000_000
