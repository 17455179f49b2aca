"""Answers that nobody reads: how many bytes may wait to be read, over all connections together.

The service sends an answer as fast as its client reads. Until then it must keep the rest, so a
client that asks for much and reads nothing would fill the memory.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import structlog
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.errors import Overloaded

log = structlog.get_logger("tubeloom.http")

SMALL_BYTES = 64 * 1024
"""What a connection may keep uncounted: as much as it takes before it asks the answer to wait."""

ABORT = "abort"
"""Where the state of a request tells how its connection is closed at once."""

TOO_MUCH = "Too much waits to be read by others; try again soon."


@dataclass(slots=True)
class Unread:
    """Bytes of all answers that are being sent: ``waiting`` now, and ``most`` at a time.

    What is sent to several clients at a time is kept once, and counts once. An answer that is
    larger than ``most`` is sent where nothing else waits.
    """

    most: int
    waiting: int = 0
    _holders: dict[int, int] = field(default_factory=dict)

    def check(self, size: int = 1) -> None:
        """Raise `Overloaded` where there is no room for ``size`` more bytes."""
        if self.waiting and self.waiting + size > self.most:
            raise Overloaded(TOO_MUCH)

    @contextmanager
    def holding(self, pieces: Sequence[bytes]) -> Iterator[None]:
        """Count ``pieces`` meanwhile. Raises `Overloaded` where that is too much."""
        distinct = {id(piece): len(piece) for piece in pieces}
        size = sum(length for key, length in distinct.items() if key not in self._holders)
        if size:
            self.check(size)
        for key in distinct:
            self._holders[key] = self._holders.get(key, 0) + 1
        self.waiting += size
        try:
            yield
        finally:
            for key, length in distinct.items():
                self._holders[key] -= 1
                if not self._holders[key]:
                    del self._holders[key]
                    self.waiting -= length


class UnreadAnswers:
    """Middleware that counts all large pieces of answers until their clients have read them.

    The connection of a client for whose piece there is no room any more is closed.
    """

    def __init__(self, app: ASGIApp, unread: Unread) -> None:
        self.app, self._unread = app, unread

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        is_dropped = False

        async def count(message: Message) -> None:
            nonlocal is_dropped
            body = message.get("body", b"")
            if is_dropped:
                return
            if len(body) <= SMALL_BYTES:
                await send(message)
                return
            try:
                with self._unread.holding((body,)):
                    await send({**message, "more_body": True})
                    # The server takes this when the client has read what went before.
                    more_body = message.get("more_body", False)
                    await send({"type": message["type"], "body": b"", "more_body": more_body})
            except Overloaded:
                is_dropped = True
                await _drop(scope, receive)

        await self.app(scope, receive, count)


async def _drop(scope: Scope, receive: Receive) -> None:
    """Close the connection of a request at once, and wait until it is closed."""
    abort: Callable[[], None] = scope["state"][ABORT]
    log.warning("connection closed: its client does not read, and too much waits")
    abort()
    while (await receive())["type"] != "http.disconnect":
        pass
