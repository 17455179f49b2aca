"""Answers that are events, and how many of them there may be at a time."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass

from fastapi.sse import EventSourceResponse
from starlette.responses import StreamingResponse
from starlette.types import Receive, Scope, Send

from app.errors import Overloaded

MEDIA_TYPE = EventSourceResponse.media_type


@dataclass(slots=True)
class EventStreams:
    """Streams that clients follow: ``open`` now, and ``most`` at a time."""

    most: int
    open: int = 0


class EventStream(StreamingResponse):
    """A stream of events. It raises `Overloaded` before it begins where there are too many."""

    def __init__(self, events: AsyncIterator[bytes], headers: Mapping[str, str]) -> None:
        headers = {"Cache-Control": "no-store", **headers}
        super().__init__(events, media_type=MEDIA_TYPE, headers=headers)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send events as they come."""
        streams: EventStreams = scope["app"].state.event_streams
        if streams.open >= streams.most:
            raise Overloaded(f"{streams.open} follow events already; try again later.")
        streams.open += 1
        try:
            await super().__call__(scope, receive, send)
        finally:
            streams.open -= 1
