"""Reading a posted document: raw bytes, up to a limit. Workers parse them, not the event loop."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass

from starlette.requests import Request

from app.api.negotiation import media_type_of
from app.api.problems import BodyTooLargeError, SlowUploadError, UnsupportedMediaTypeError
from app.api.queries import PostedQuery
from app.errors import Overloaded
from app.formats.registry import FORMATS
from app.settings import Settings

FORM = "application/x-www-form-urlencoded"
"""What ``curl --data-binary`` says of whatever it sends; taken for JSON out of kindness."""

MOST_REPEATED = 200
"""Characters of a header that a message repeats."""

MOST_NEEDLESS_BYTES = 65_536
"""That are passed over where nothing is wanted."""


@dataclass(slots=True)
class HeldBodies:
    """Bodies of all requests that are being served: ``bytes`` now, and ``most`` at a time."""

    most: int
    bytes: int = 0

    def hold(self, request: Request, size: int) -> None:
        """Count ``size`` bytes for ``request``. Raises `Overloaded` where that is too much."""
        if self.bytes + size > self.most:
            raise Overloaded("Too much is being read already; try again soon.")
        self.bytes += size
        state = request.scope.setdefault("state", {})
        state["held_bytes"] = state.get("held_bytes", 0) + size

    def release(self, size: int) -> None:
        """Give back what a request held that has been answered."""
        self.bytes -= size


async def read_document(request: Request, limit: int) -> bytes:
    """The body of ``request``, of at most ``limit`` bytes.

    Raises `UnsupportedMediaTypeError`, `SlowUploadError`, `Overloaded` where too much is being
    read at a time, and `BodyTooLargeError`, the latter as soon as it is known.
    """
    _check_is_json(request.headers)
    return await _in_time(request, limit)


async def pass_over_body(request: Request) -> None:
    """Read what a request carries that should carry nothing, so that only its end can come.

    Raises `BodyTooLargeError` and `SlowUploadError`.
    """
    await _in_time(request, MOST_NEEDLESS_BYTES)


async def _in_time(request: Request, limit: int) -> bytes:
    settings: Settings = request.app.state.settings
    try:
        async with asyncio.timeout(settings.upload_seconds):
            return await _read(request, limit)
    except TimeoutError:
        raise SlowUploadError(_too_slow(settings)) from None


async def has_body(request: Request) -> bool:
    """Whether anything comes as a body; no more than its beginning is read.

    Raises `SlowUploadError`.
    """
    settings: Settings = request.app.state.settings
    try:
        async with asyncio.timeout(settings.upload_seconds):
            async for chunk in request.stream():
                if chunk:
                    return True
    except TimeoutError:
        raise SlowUploadError(_too_slow(settings)) from None
    return False


async def _read(request: Request, limit: int) -> bytes:
    held: HeldBodies = request.app.state.held_bodies
    declared = request.headers.get("content-length", "")
    if declared.isdecimal() and int(declared) > limit:
        raise BodyTooLargeError(_too_large(limit))
    body = bytearray()
    async for chunk in request.stream():
        body += chunk
        if len(body) > limit:
            raise BodyTooLargeError(_too_large(limit))
        held.hold(request, len(chunk))
    return bytes(body)


def declared_media_type(headers: Mapping[str, str]) -> str:
    """What the client says that it sends, without parameters; JSON where it says nothing."""
    return media_type_of(headers.get("content-type") or "application/json")


def source_of(request: Request, query: PostedQuery) -> str:
    """The format of the posted document: as asked, or as its media type tells."""
    if query.source is not None:
        return query.source
    media_type = declared_media_type(request.headers)
    return next(
        (name for name, found in FORMATS.items() if found.media_type == media_type), "tubeloom"
    )


def _check_is_json(headers: Mapping[str, str]) -> None:
    coding = headers.get("content-encoding", "identity").strip().lower()
    if coding not in {"identity", ""}:
        raise UnsupportedMediaTypeError(
            f"Send the document as it is, not as {coding[:MOST_REPEATED]}."
        )
    media_type = declared_media_type(headers)
    if media_type not in {"application/json", FORM} and not (
        media_type.startswith("application/") and media_type.endswith("+json")
    ):
        sent = headers.get("content-type", "")[:MOST_REPEATED]
        raise UnsupportedMediaTypeError(f"Send the document as application/json, not as {sent}.")


def _too_large(limit: int) -> str:
    return f"The body has more than the {limit} bytes that this service takes."


def _too_slow(settings: Settings) -> str:
    return f"The body did not come within {settings.upload_seconds:g} seconds."
