"""A worker process: reads works from its socket, answers them one after another.

Run as ``python -m app.jobs.worker FD``, where FD is its end of a socket pair. Native code that
crashes takes this process with it and nothing else.
"""

from __future__ import annotations

import gc
import itertools
import math
import os
import resource
import select
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from functools import partial

from app.answers import Answer, LayoutOptions, RenderOptions
from app.errors import TubeloomError
from app.jobs import channel
from app.jobs.shortage import shortage
from app.jobs.work import Crash, Ready, Reply, Report, Stage, Work
from app.output.memory_needs import held_bytes
from app.program.collection import collection_paused
from app.settings import Settings

WARM_UP = b"""{
  "items": [{"id": "a", "label": "a"}, {"id": "b", "shape": {"type": "sphere"}}, {"id": "c"}],
  "hyperedges": [{"id": "e", "attachments": [{"item": "a"}, {"item": "b"}, {"item": "c"}]}]
}"""
"""A program that takes every kernel through its first call, which loads it."""

REPORT_SECONDS = 0.1
"""Between two reports: more often nobody can see."""


def main() -> None:
    """Serve the socket whose descriptor is the first argument, until its other end closes."""
    # Ctrl-C goes to the whole group; the service ends its workers itself.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    end = socket.socket(fileno=int(sys.argv[1]))
    threading.Thread(target=_die_with_the_service, args=(end,), daemon=True).start()
    # Imports leave next to no garbage, and to look for it would take a tenth of their time.
    with collection_paused():
        import app.pipeline  # noqa: F401 - before the settings come
    gc.freeze()
    try:
        settings: Settings = channel.receive(end)[0]
        # So that a scene too large ends in an error here, and not in the system's choice of victim.
        resource.setrlimit(resource.RLIMIT_DATA, 2 * (settings.max_worker_bytes,))
        channel.send(end, _prepare(settings))
        while True:
            try:
                work, document = channel.receive(end)
            except MemoryError as error:
                found = shortage(error, LayoutOptions(), settings)
                channel.send(end, Reply(found or Crash(traceback.format_exc()), is_spent=True))
                continue
            reply, body = do(work, document, settings, partial(channel.send, end))
            del work, document
            if held_bytes() - len(body) > settings.kept_worker_bytes:
                reply = replace(reply, is_spent=True)
            channel.send(end, reply, body)
            del reply, body
    except (EOFError, OSError):
        return


def _unheard(_report: Report, _preview: bytes) -> None:
    """Where nobody listens."""


def do(
    work: Work,
    document: bytes,
    settings: Settings,
    send: Callable[[Report, bytes], None] = _unheard,
) -> tuple[Reply, bytes]:
    """Answer one work, and ``send`` reports if it wants them. What goes wrong is in the reply."""
    from app import pipeline
    from app.shared_layout import SharedLayout

    stages: list[tuple[str, float]] = []
    reported = -math.inf
    share_done = 0.0

    def note(stage: str, share: float) -> None:
        nonlocal reported, share_done
        now = time.perf_counter()
        share_done = share
        if not stages or stages[-1][0] != stage:
            stages.append((stage, now))
        if work.reports and now >= reported + REPORT_SECONDS:
            reported = now
            send(Report(stage, share), b"")

    def show(picture: bytes) -> None:
        send(Report(stages[-1][0], share_done), picture)

    began = time.monotonic()

    def spent() -> float:
        return (time.monotonic() - began) / work.seconds if work.seconds else 0.0

    shared = SharedLayout(work.shared)
    try:
        outcome = pipeline.answer(
            document,
            work.options,
            settings,
            work.known,
            note,
            show if work.reports else None,
            work.layout,
            shared,
            spent,
        )
    except Exception as error:
        if (found := shortage(error, work.options, settings)) is not None:
            return Reply(found, _durations(stages), is_spent=True), b""
        if isinstance(error, TubeloomError):
            return Reply(error, _durations(stages)), b""
        return Reply(Crash(traceback.format_exc()), _durations(stages)), b""
    if isinstance(outcome, Answer):
        reply = Reply(replace(outcome, body=b""), _durations(stages), shared=shared.made)
        return reply, outcome.body
    return Reply(outcome, _durations(stages)), b""


def _prepare(settings: Settings) -> Ready | Crash:
    """Load every kernel, before the first work comes."""
    from app.output.draft import draft_problem

    reply, _ = do(Work(RenderOptions()), WARM_UP, settings)
    if isinstance(reply.outcome, Crash):
        return reply.outcome
    if isinstance(reply.outcome, TubeloomError):
        raise reply.outcome
    # Else a full collection in the midst of somebody's work would look, for 80 ms, at all that
    # the kernels have left.
    gc.collect()
    gc.freeze()
    return Ready(draft_problem())


def _durations(stages: list[tuple[str, float]]) -> tuple[Stage, ...]:
    ends = [*stages, ("", time.perf_counter())]
    return tuple(
        Stage(name, end - start)
        for (name, start), (_, end) in itertools.pairwise(ends)
        if name != "done"
    )


def _die_with_the_service(end: socket.socket) -> None:
    """Wait until the other end is closed, be it by ``kill -9``, and end this process at once."""
    hang_up = select.poll()
    hang_up.register(end.fileno(), 0)
    hang_up.poll()
    os._exit(0)


if __name__ == "__main__":
    main()
