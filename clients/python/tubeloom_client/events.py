"""Server-sent events, as they come in pieces."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx

MEDIA_TYPE = "text/event-stream"
CONNECT_SECONDS = 10.0
SILENCE_SECONDS = 30.0
"""The service says something every ten seconds; a stream that does not is broken."""


@dataclass(frozen=True, slots=True)
class Event:
    """One event: its name, its data as JSON, and the id of the last event that had one."""

    name: str
    data: Any
    id: str | None


class EventReader:
    """Makes events of the bytes of a stream; ``last_id`` is where to go on after a break."""

    def __init__(self, last_id: str | None = None) -> None:
        self.last_id = last_id
        self._rest = b""
        self._name = ""
        self._data: list[str] = []
        self._id = last_id

    def opening(self) -> dict[str, Any]:
        """How to ask for the stream, or for the rest of it."""
        headers = {"Accept": MEDIA_TYPE, "Cache-Control": "no-store"}
        if self.last_id is not None:
            headers["Last-Event-ID"] = self.last_id
        return {"headers": headers, "timeout": httpx.Timeout(CONNECT_SECONDS, read=SILENCE_SECONDS)}

    def interrupted(self) -> None:
        """Forget the event that was not finished: it will come again."""
        self._rest, self._name, self._data = b"", "", []
        self._id = self.last_id

    def feed(self, piece: bytes) -> Iterator[Event]:
        """The events that ``piece`` completes."""
        lines = (self._rest + piece).split(b"\n")
        self._rest = lines.pop()
        for line in lines:
            event = self._line(line.removesuffix(b"\r").decode())
            if event is not None:
                yield event

    def _line(self, line: str) -> Event | None:
        if not line:
            return self._finish()
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        match field:
            case "event":
                self._name = value
            case "data":
                self._data.append(value)
            case "id":
                self._id = value
        return None

    def _finish(self) -> Event | None:
        name, data = self._name, self._data
        self._name, self._data = "", []
        self.last_id = self._id
        if not data:
            return None
        return Event(name or "message", json.loads("\n".join(data)), self.last_id)
