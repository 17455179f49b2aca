"""Which key a request comes with: the stored ones, remembered for a few seconds."""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict

import structlog

from app.errors import StoreUnavailable
from app.store import keys
from app.store.database import Database
from app.store.keys import Key

log = structlog.get_logger("tubeloom.keys")

MOST_REMEMBERED = 10_000

USE_SECONDS = 60.0
"""How exactly it is known when a key was used."""


class Keyring:
    """The keys in a database; each look into it is believed for ``memory_seconds``."""

    def __init__(self, database: Database, memory_seconds: float) -> None:
        self._database, self._memory_seconds = database, memory_seconds
        self._found: OrderedDict[str, tuple[float, Key | None]] = OrderedDict()
        self._noted: dict[str, float] = {}
        self._notes: set[asyncio.Task[None]] = set()

    def remembered(self, secret: str) -> Key | None:
        """The key, if it was found valid a moment ago."""
        until, key = self._found.get(keys.digest_of(secret), (0.0, None))
        return key if time.monotonic() < until else None

    async def find(self, secret: str) -> Key | None:
        """The valid key with this ``secret``, if there is one. Raises `StoreUnavailable`."""
        digest = keys.digest_of(secret)
        until, key = self._found.get(digest, (0.0, None))
        if time.monotonic() < until:
            return key
        key = await self._database.read(lambda connection: keys.find(connection, digest))
        self._found[digest] = time.monotonic() + self._memory_seconds, key
        self._found.move_to_end(digest)
        if len(self._found) > MOST_REMEMBERED:
            self._found.popitem(last=False)
        if key is not None:
            self._note_use(key)
        return key

    def _note_use(self, key: Key) -> None:
        now = time.monotonic()
        if now < self._noted.get(key.id, -USE_SECONDS) + USE_SECONDS:
            return
        self._noted[key.id] = now
        note = asyncio.create_task(self._write_use(key.id))
        self._notes.add(note)
        note.add_done_callback(self._notes.discard)

    async def _write_use(self, key_id: str) -> None:
        try:
            await self._database.write(lambda connection: keys.note_use(connection, [key_id]))
        except StoreUnavailable:
            log.warning("use of a key not noted", key=key_id)
