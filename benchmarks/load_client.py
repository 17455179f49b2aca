"""A client of HTTP for measuring: it takes little time itself, and reuses its connections."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

PATIENCE_SECONDS = 60.0
"""Who waits longer for an answer calls it an error."""


@dataclass(frozen=True, slots=True)
class Reply:
    """What came back (status 0: nothing), and the seconds until all of it had come."""

    status: int
    headers: Mapping[str, str]
    size: int
    seconds: float


class Client:
    """Asks one service, over as many connections as there are questions at a time."""

    def __init__(self, url: str) -> None:
        address = urlsplit(url)
        self._host, self._port = str(address.hostname), int(address.port or 80)
        self._free: list[tuple[asyncio.StreamReader, asyncio.StreamWriter]] = []

    async def post(self, path: str, body: bytes, began: float | None = None) -> Reply:
        """Send JSON. The time counts from ``began``, of `time.perf_counter`, or from now."""
        began = time.perf_counter() if began is None else began
        try:
            async with asyncio.timeout(PATIENCE_SECONDS):
                status, headers, size = await self._exchange(path, body)
        except (OSError, EOFError, TimeoutError):
            status, headers, size = 0, {}, 0
        return Reply(status, headers, size, time.perf_counter() - began)

    def close(self) -> None:
        """Close all connections."""
        for _, writer in self._free:
            writer.close()
        self._free.clear()

    async def _exchange(self, path: str, body: bytes) -> tuple[int, dict[str, str], int]:
        head = (
            f"POST {path} HTTP/1.1\r\nHost: {self._host}\r\nContent-Type: application/json\r\n"
            f"Content-Length: {len(body)}\r\n\r\n"
        ).encode()
        while self._free:
            reader, writer = self._free.pop()
            try:
                writer.write(head + body)
                return await self._receive(reader, writer)
            except (OSError, EOFError):  # it was closed while nobody used it
                writer.close()
        reader, writer = await asyncio.open_connection(self._host, self._port, limit=1 << 22)
        try:
            writer.write(head + body)
            return await self._receive(reader, writer)
        except BaseException:
            writer.close()
            raise

    async def _receive(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> tuple[int, dict[str, str], int]:
        first, *lines = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")[:-2]
        pairs = (line.partition(":") for line in lines)
        headers = {name.lower(): value.strip() for name, _, value in pairs}
        size = int(headers.get("content-length", "0"))
        missing = size
        while missing:
            piece = await reader.read(missing)
            if not piece:
                raise EOFError
            missing -= len(piece)
        if headers.get("connection") == "close":
            writer.close()
        else:
            self._free.append((reader, writer))
        return int(first.split(" ", 2)[1]), headers, size
