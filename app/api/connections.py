"""Connections that nobody can hold for long by saying little, nor fill by saying too much."""

from __future__ import annotations

import asyncio
from typing import ClassVar, cast

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

from app.api.unread import ABORT
from app.api.watched_transport import WatchedTransport
from app.settings import Settings

HEAD_BYTES = 64 * 1024

TOO_LARGE = (
    b"HTTP/1.1 431 Request Header Fields Too Large\r\n"
    b"connection: close\r\ncontent-length: 0\r\n\r\n"
)


class Connection(HttpToolsProtocol):
    """One connection, as uvicorn serves it; it is closed when it is not used as it should be."""

    head_seconds: ClassVar[float]
    """How long the head of a request may take to come, and the rest of a body nobody reads."""

    write_seconds: ClassVar[float]
    """After which it is closed where the client does not read what it asked for."""

    _timer: asyncio.TimerHandle | None = None
    _head_bytes = 0
    _in_head = True

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Begin to wait."""
        inner = cast("asyncio.Transport", transport)
        self._watched = WatchedTransport(inner, self.loop, self.write_seconds)
        super().connection_made(self._watched)
        self._close_in(self.head_seconds)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._stop_timer()
        self._watched.stop_watching()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Take what came, unless it is more than a head may have."""
        super().data_received(data)
        if self._timer is None and self._is_answered():
            self._close_in(self.head_seconds)
        if self._in_head:
            self._head_bytes += len(data)
            if self._head_bytes > HEAD_BYTES and not self.transport.is_closing():
                self.transport.write(TOO_LARGE)
                self.transport.close()

    def on_message_begin(self) -> None:
        """A head begins."""
        super().on_message_begin()
        self.scope["state"][ABORT] = self._watched.abort
        self._in_head, self._head_bytes = True, 0
        self._close_in(self.head_seconds)

    def on_headers_complete(self) -> None:
        """The head has come."""
        self._in_head = False
        self._stop_timer()
        super().on_headers_complete()

    def on_response_complete(self) -> None:
        """The answer has gone; what still comes of the body is waited for, but not for ever."""
        super().on_response_complete()
        if self._is_answered() and self.cycle.more_body and not self.transport.is_closing():
            self._close_in(self.head_seconds)

    def _is_answered(self) -> bool:
        return self.cycle is None or self.cycle.response_complete

    def _close_in(self, seconds: float) -> None:
        self._stop_timer()
        self._timer = self.loop.call_later(seconds, self._close)

    def _close(self) -> None:
        if not self.transport.is_closing():
            self.transport.close()

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


def connections(settings: Settings) -> type[Connection]:
    """The class of connections that may take as long as the ``settings`` say."""

    class Limited(Connection):
        head_seconds = settings.head_seconds
        write_seconds = settings.write_seconds

    return Limited
