"""Answers of the pipeline as HTTP responses."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from app.answers import Answer
from app.api.conditions import entity_tag
from app.api.unread import Unread
from app.jobs.executor import Finished

NOTES = "Tubeloom"
"""Begins the names of headers that tell how an answer came about."""

COMMON_HEADERS = {"Vary": "Accept", "Cache-Control": "no-cache"}
"""Whoever keeps an answer must ask whether it is still right, which its validator makes cheap."""


class PiecesResponse(Response):
    """A response whose body goes out in the pieces in which it came.

    They count as unread until the client has them. Where too much is unread already, the response
    raises `Overloaded` before it begins.
    """

    def __init__(
        self, pieces: Sequence[bytes], media_type: str, headers: Mapping[str, str]
    ) -> None:
        self.pieces = pieces
        size = sum(map(len, pieces))
        super().__init__(media_type=media_type, headers={**headers, "Content-Length": str(size)})

    async def __call__(self, scope: Scope, _receive: Receive, send: Send) -> None:
        """Send the head, then piece by piece."""
        unread: Unread = scope["app"].state.unread
        with unread.holding(self.pieces):
            await send(
                {
                    "type": "http.response.start",
                    "status": self.status_code,
                    "headers": self.raw_headers,
                }
            )
            for piece in self.pieces[:-1]:
                await send({"type": "http.response.body", "body": piece, "more_body": True})
            last = self.pieces[-1] if self.pieces else b""
            await send({"type": "http.response.body", "body": last})


def response_of(finished: Finished, ending: str) -> Response:
    """The answer with its headers, or 304 where the client has it. ``ending`` is of the file."""
    headers = headers_of(finished, ending)
    if not isinstance(finished.answer, Answer):
        return Response(status_code=304, headers=headers)
    return PiecesResponse(finished.pieces, finished.answer.media_type, headers)


def headers_of(finished: Finished, ending: str) -> dict[str, str]:
    """What is said of an answer beside its media type. ``ending`` is of the file."""
    answer = finished.answer
    headers = {**COMMON_HEADERS, "Server-Timing": server_timing(finished)}
    if finished.cache is not None:
        headers[f"{NOTES}-Cache"] = finished.cache
    if answer.etag is not None:
        headers["ETag"] = entity_tag(answer.etag)
    if isinstance(answer, Answer):
        headers["Content-Disposition"] = content_disposition(answer.name, ending)
        headers.update((f"{NOTES}-{name}", note) for name, note in answer.notes.items())
    return headers


def content_disposition(name: str | None, ending: str) -> str:
    """How a browser saves the answer: by the document's name, with nothing odd in it.

    >>> content_disposition("ID3 Tree, clause 2", "glb")
    'inline; filename="ID3-Tree-clause-2.glb"'
    """
    name = (name or "").strip()
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    safe = re.sub(r"[^A-Za-z0-9_]+", "-", plain).strip("-")[:80] or "program"
    value = f'inline; filename="{safe}.{ending}"'
    if not name.isascii():
        value += f"; filename*=UTF-8''{quote(name[:80], safe='', errors='replace')}.{ending}"
    return value


def server_timing(finished: Finished) -> str:
    """How long the request waited for a worker, and how long each stage of the work took."""
    parts: dict[str, Any] = {"waiting": finished.waited}
    parts.update((stage.name, stage.seconds) for stage in finished.stages)
    return ", ".join(
        f"{name.replace(' ', '-')};dur={seconds * 1000:.2f}" for name, seconds in parts.items()
    )
