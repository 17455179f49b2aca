"""A connection whose client does not read what it asked for is closed.

asyncio keeps what a client does not read for as long as the connection is open, also after
``close()``, which waits until all has been read.
"""

from __future__ import annotations

import asyncio
import fcntl
import struct
import termios
from collections.abc import Iterable
from typing import Any

import structlog

log = structlog.get_logger("tubeloom.http")

LEAST_BYTES = 64 * 1024
"""That a client must read of what waits for it, each time that the connection is looked at."""

Buffer = bytes | bytearray | memoryview


class WatchedTransport(asyncio.Transport):
    """The transport ``inner``, looked at every so many ``seconds`` for as long as bytes wait.

    It is aborted where the client has read less than `LEAST_BYTES`, and less than waited, since. So
    who reads nothing is let go after ``seconds`` at the earliest, and soon after twice that.
    """

    def __init__(
        self, inner: asyncio.Transport, loop: asyncio.AbstractEventLoop, seconds: float
    ) -> None:
        super().__init__()
        self._inner, self._loop, self._seconds = inner, loop, seconds
        self._written = 0
        self._taken = self._outstanding = 0
        self._timer: asyncio.TimerHandle | None = None

    def write(self, data: Buffer) -> None:
        """Send ``data`` as soon as the client reads."""
        self._written += len(data)
        self._inner.write(data)
        if self._timer is None:
            self._note()
            self._timer = self._loop.call_later(self._seconds, self._look)

    def writelines(self, list_of_data: Iterable[Buffer]) -> None:
        """Send all of it."""
        for data in list_of_data:
            self.write(data)

    def abort(self) -> None:
        """Close at once; what waits is forgotten."""
        self.stop_watching()
        self._inner.abort()

    def stop_watching(self) -> None:
        """Look no more: the connection is closed."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _look(self) -> None:
        self._timer = None
        if self._inner.get_write_buffer_size() == 0:
            return
        before, due = self._taken, min(LEAST_BYTES, self._outstanding)
        self._note()
        if self._taken - before < due:
            log.warning("connection closed: its client does not read")
            self._inner.abort()
        else:
            self._timer = self._loop.call_later(self._seconds, self._look)

    def _note(self) -> None:
        """Note how much the client has taken, and how much it has not."""
        self._outstanding = self._inner.get_write_buffer_size() + _unacknowledged(self._inner)
        self._taken = self._written - self._outstanding

    # What follows is the inner transport's.

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        """What is known of the connection."""
        return self._inner.get_extra_info(name, default)

    def is_closing(self) -> bool:
        """Whether it is closed, or about to be."""
        return self._inner.is_closing()

    def close(self) -> None:
        """Close when all has been read."""
        self._inner.close()

    def set_protocol(self, protocol: asyncio.BaseProtocol) -> None:
        """Have another protocol go on."""
        self._inner.set_protocol(protocol)

    def get_protocol(self) -> asyncio.BaseProtocol:
        """The protocol that is told of the connection."""
        return self._inner.get_protocol()

    def is_reading(self) -> bool:
        """Whether what the client sends is taken."""
        return self._inner.is_reading()

    def pause_reading(self) -> None:
        """Take nothing that the client sends."""
        self._inner.pause_reading()

    def resume_reading(self) -> None:
        """Take again what the client sends."""
        self._inner.resume_reading()

    def set_write_buffer_limits(self, high: int | None = None, low: int | None = None) -> None:
        """When the protocol is told to pause, and to go on."""
        self._inner.set_write_buffer_limits(high, low)

    def get_write_buffer_size(self) -> int:
        """Bytes that this process keeps."""
        return self._inner.get_write_buffer_size()

    def get_write_buffer_limits(self) -> tuple[int, int]:
        """When the protocol is told to go on, and to pause."""
        return self._inner.get_write_buffer_limits()

    def write_eof(self) -> None:
        """Say that nothing more will come."""
        self._inner.write_eof()

    def can_write_eof(self) -> bool:
        """Whether that can be said."""
        return self._inner.can_write_eof()


def _unacknowledged(transport: asyncio.Transport) -> int:
    """Bytes that the system keeps for the client; 0 where it does not tell."""
    socket = transport.get_extra_info("socket")
    try:
        told = fcntl.ioctl(socket.fileno(), termios.TIOCOUTQ, bytes(4))
    except (AttributeError, OSError, ValueError):
        return 0
    found: int = struct.unpack("i", told)[0]
    return found
