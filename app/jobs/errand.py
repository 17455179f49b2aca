"""A work as a task of a Dask worker: a child process does it, which can be ended.

The child is the same worker process that the service itself has. A task that nobody wants any more
keeps running in Dask; this one sees that it is not wanted, and ends its child. Where the Dask
worker dies, the child does so by itself.
"""

from __future__ import annotations

import select
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from app.errors import DeadlineExceeded
from app.jobs import channel
from app.jobs.launch import launch
from app.jobs.work import SOON_OVER, Crash, Ready, Reply, Report, Work
from app.settings import Settings

POLL_SECONDS = 0.1
"""Between two looks whether the work is still wanted."""

START_SECONDS = 300.0
"""A child that is not warm by then is stuck."""


@dataclass(frozen=True, slots=True)
class ChildLost:
    """In place of a reply: the child died over the work."""


class UnwantedError(Exception):
    """Nobody wants the work any more."""


class Child:
    """A worker process, for one work at a time. Raises `OSError` and `EOFError` when it dies."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        launched = launch()
        self._process, self._end = launched.process, launched.end
        self.is_warm = False
        self.works = 0
        """How many works it was handed."""

    def send(self, head: object, payload: bytes = b"") -> None:
        """Give it a work, or at first the settings."""
        channel.send(self._end, head, payload)

    def heard(self, seconds: float) -> tuple[Any, bytes] | None:
        """What it says within so many seconds, if it says something."""
        if not select.select([self._end], [], [], seconds)[0]:
            return None
        return channel.receive(self._end)

    def kill(self) -> None:
        """End it at once."""
        self._process.kill()
        self._end.close()
        self._process.wait()


_idle: list[Child] = []
_lock = threading.Lock()


def run(
    key: str, work: Work, document: bytes, settings: Settings, topic: str
) -> tuple[Reply | ChildLost, bytes]:
    """Do the work of the task ``key``; reports are events of ``topic``. Raises `UnwantedError`."""
    from distributed import get_worker

    worker = get_worker()

    def check() -> None:
        task = worker.state.tasks.get(key)
        if task is None or task.state not in {"executing", "long-running"}:
            raise UnwantedError(key)
        if worker.status.name not in {"running", "paused", "closing_gracefully"}:
            raise UnwantedError(key)

    def tell(report: Report) -> None:
        worker.log_event(topic, {"key": key, "stage": report.stage, "share": report.share})

    return do(work, document, settings, check, tell)


def do(
    work: Work,
    document: bytes,
    settings: Settings,
    check: Callable[[], None],
    tell: Callable[[Report], None],
) -> tuple[Reply | ChildLost, bytes]:
    """Do the work as long as ``check`` does not raise; ``tell`` hears how it goes on."""
    child = _take(settings)
    reply, body = _do(child, work, document, check, tell)
    if isinstance(reply, Reply) and reply.ran_out and child.works > 1:
        # What fits must not depend on what the child did before.
        reply, body = _do(Child(settings), work, document, check, tell)
    return reply, body


def _do(
    child: Child,
    work: Work,
    document: bytes,
    check: Callable[[], None],
    tell: Callable[[Report], None],
) -> tuple[Reply | ChildLost, bytes]:
    settings, came = child.settings, time.monotonic()
    try:
        if not child.is_warm:
            child.send(settings)
            ready, _ = _next(child, check, tell, START_SECONDS)
            if not isinstance(ready, Ready):
                return _failed(child, ready)
            child.is_warm = True
        child.works += 1
        if work.seconds is not None:  # less what the child took to start
            left = work.seconds - (time.monotonic() - came)
            work = replace(work, seconds=max(left, SOON_OVER))
        child.send(work, document)
        reply, body = _next(child, check, tell, settings.deadline_seconds)
    except (OSError, EOFError):
        child.kill()
        return ChildLost(), b""
    except BaseException:
        child.kill()
        raise
    if isinstance(reply, Reply):
        if reply.is_spent:
            child.kill()
        else:
            with _lock:
                _idle.append(child)
        return reply, body
    return _failed(child, reply)


def _next(
    child: Child, check: Callable[[], None], tell: Callable[[Report], None], seconds: float
) -> tuple[Any, bytes]:
    """What it says that is not a report; ``None`` where it says nothing in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        check()
        if (news := child.heard(POLL_SECONDS)) is None:
            continue
        if not isinstance(news[0], Report):
            return news
        if not news[1]:
            tell(news[0])
    return None, b""


def _failed(child: Child, said: object) -> tuple[Reply | ChildLost, bytes]:
    child.kill()
    if isinstance(said, Crash):
        return Reply(said), b""
    if said is None and child.is_warm:
        late = f"The work took longer than {child.settings.deadline_seconds:g} seconds."
        return Reply(DeadlineExceeded(late)), b""
    return ChildLost(), b""


def _take(settings: Settings) -> Child:
    with _lock:
        while _idle:
            child = _idle.pop()
            if child.settings == settings:
                return child
            child.kill()
    return Child(settings)
