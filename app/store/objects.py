"""Objects: bytes under names, in a folder or in object storage."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit
from urllib.request import url2pathname

import structlog
from obstore.exceptions import BaseError
from obstore.store import LocalStore, ObjectStore, from_url

from app.errors import StoreUnavailable

if TYPE_CHECKING:
    from obstore.store import ClientConfig, RetryConfig

log = structlog.get_logger("tubeloom.store")

_FAILURES = (BaseError, OSError, ValueError)
"""What obstore raises where a store does not do what it is asked to."""


CONNECT_TIME = timedelta(seconds=2)
RETRY_TIME = timedelta(seconds=5)

ANSWER_SECONDS = 3.0
"""Who waits longer for the beginning of an object had rather work the answer out anew."""


class Objects:
    """Where objects lie. Each is there as a whole or not at all."""

    def __init__(self, place: str | Path) -> None:
        """``place`` is a folder or the URL of one, or of object storage. Raises `ValueError`."""
        self._store, self._folder = _store(place)

    async def get(self, path: str) -> memoryview | None:
        """The bytes, or ``None`` where there are none. Raises `StoreUnavailable`."""
        try:
            async with asyncio.timeout(ANSWER_SECONDS):
                found = await self._store.get_async(path)
            return memoryview(await found.bytes_async())
        except FileNotFoundError:
            return None
        except _FAILURES as error:
            raise _unavailable("read", path, error) from error

    async def put(self, path: str, pieces: Sequence[bytes]) -> None:
        """Keep the bytes. Raises `StoreUnavailable`."""
        try:
            await self._store.put_async(path, pieces[0] if len(pieces) == 1 else pieces)
        except _FAILURES as error:
            raise _unavailable("stored", path, error) from error

    async def delete(self, paths: Iterable[str]) -> None:
        """Delete what there is of ``paths``; what cannot be deleted now stays."""
        for path in paths:
            try:
                await self._store.delete_async(path)
            except FileNotFoundError:
                continue
            except _FAILURES as error:
                log.warning("result cannot be deleted", path=path, error=_first_line(error))

    async def times(self) -> dict[str, float]:
        """When each object was written, in seconds since 1970. Raises `StoreUnavailable`."""
        found: dict[str, float] = {}
        try:
            async for chunk in self._store.list():
                found.update((each["path"], each["last_modified"].timestamp()) for each in chunk)
        except _FAILURES as error:
            raise _unavailable("listed", "", error) from error
        return found

    async def delete_unfinished(self, seconds: float) -> None:
        """Delete what a crash left half written, if it is older than that."""
        if self._folder is not None:
            await asyncio.to_thread(_delete_unfinished, self._folder, time.time() - seconds)


def _store(place: str | Path) -> tuple[ObjectStore, Path | None]:
    """A store, and its folder if it has one."""
    if isinstance(place, str) and "://" in place and not place.startswith("file:"):
        try:
            return _far_store(place), None
        except _FAILURES as error:
            raise ValueError(f"Results cannot be kept at {place}: {error}") from error
    is_url = isinstance(place, str) and place.startswith("file:")
    folder = Path(url2pathname(urlsplit(str(place)).path)) if is_url else Path(place)
    folder.mkdir(parents=True, exist_ok=True)
    return LocalStore(folder), folder


def _far_store(url: str) -> ObjectStore:
    if url.startswith("memory:"):
        return from_url(url)
    client: ClientConfig = {
        "connect_timeout": CONNECT_TIME,
        # obstore reads this itself, but not where it is told anything else.
        "allow_http": os.environ.get("AWS_ALLOW_HTTP", "").lower() in {"1", "true"},
    }
    retries: RetryConfig = {"max_retries": 2, "retry_timeout": RETRY_TIME}
    return from_url(url, client_options=client, retry_config=retries)


def _delete_unfinished(folder: Path, oldest: float) -> None:
    for file in folder.glob("*/*#*"):  # so obstore names what it is writing
        with suppress(FileNotFoundError):
            if file.stat().st_mtime < oldest:
                file.unlink()


def _unavailable(deed: str, path: str, error: Exception) -> StoreUnavailable:
    log.warning(f"result cannot be {deed}", path=path, error=_first_line(error))
    return StoreUnavailable("The store of results does not answer; try again soon.")


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0] or type(error).__name__
