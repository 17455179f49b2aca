"""How long to try again where the service is away or busy."""

from __future__ import annotations

import time

import httpx

from tubeloom_client.problems import Busy, Unreachable

FIRST_PAUSE_SECONDS = 0.1
LONGEST_PAUSE_SECONDS = 5.0


class Patience:
    """So many seconds to try again; pauses double, unless the service says how long to wait."""

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self.restore()

    def restore(self) -> None:
        """Start anew: something has gone well."""
        self.take_heart()
        self._pause = FIRST_PAUSE_SECONDS

    def take_heart(self) -> None:
        """Be as patient as in the beginning: somebody has answered, if only that."""
        self._end: float | None = None

    def pause_after(self, error: Busy | httpx.TransportError) -> float:
        """Seconds to wait before the next try.

        Raises the error, a broken connection as `Unreachable`, where patience has run out or
        waiting is of no use: an answer that takes too long would do so again.
        """
        now = time.monotonic()
        if self._end is None:
            self._end = now + self._seconds
        if isinstance(error, Busy):
            wait, is_passing = error.retry_after or 0.0, error.retry_after is not None
        else:
            wait, is_passing = self._pause, True
            self._pause = min(2 * self._pause, LONGEST_PAUSE_SECONDS)
        if is_passing and now + wait <= self._end:
            return wait
        if isinstance(error, Busy):
            raise error
        raise Unreachable(f"No answer: {error or type(error).__name__}.") from error
