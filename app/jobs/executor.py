"""Worker processes that answer calls of the pipeline, and the line that waits for them.

Each process does one work at a time, so one that native code kills takes only that work with it;
the work is tried once more, and the process replaced. So is one that is spent: where memory runs
out in a worker that has worked before, the work is done again in one that has not, so that what
fits never depends on what a worker did.
"""

from __future__ import annotations

import asyncio
import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Self

import structlog

from app.answers import (
    Answer,
    Change,
    Options,
    RenderOptions,
    Revised,
    ReviseOptions,
    Unchanged,
    is_slow,
)
from app.errors import DeadlineExceeded, Overloaded, RendererUnavailable, WorkerLost
from app.jobs.launch import Launched
from app.jobs.process import Listener, WorkerDiedError, WorkerProcess
from app.jobs.work import SOON_OVER, Crash, Outcome, Reply, Stage, Work
from app.output.media import SceneFormat
from app.settings import Settings

log = structlog.get_logger("tubeloom.jobs")

START_SECONDS = 300.0
"""A worker that is not warm by then is stuck; compiling every kernel anew takes some 30."""

GRACE_SECONDS = 0.5
"""How long work that nobody waits for may go on, unless it is known to be slow: new workers take
longer to start."""

PROMPT_SECONDS = 3.0
"""How long a line may take, by what works took lately, unless it is short: who would wait longer is
better told at once, and a line that has grown is soon gone again."""

SHORT_LINE = 4
"""Works for each worker, which may wait however long those before them take."""

NOT_DRAWN = "No worker has drawn a picture yet."

LONGEST_PAUSE_SECONDS = 30.0
"""Between attempts to start workers that die at their start."""


Witness = Callable[[float, tuple[Stage, ...]], None]
"""Told of each work that a worker did: its seconds, and its stages if it came to an end. It is
called in the context of whoever asked."""


class UnexpectedError(Exception):
    """The pipeline raised what it never should; carries the worker's traceback."""


@dataclass(frozen=True, slots=True)
class Finished:
    """An answer, the seconds it waited for a worker, and how long its stages took.

    The answer's body stands apart, in the pieces in which it came. ``cache`` tells whether it was
    there already, or had to be worked out: for this asker, or also for others. ``shared`` is the
    layout that was made for it.
    """

    answer: Answer | Unchanged
    pieces: tuple[bytes, ...]
    waited: float
    stages: tuple[Stage, ...]
    cache: Literal["hit", "miss", "shared"] | None = None
    shared: bytes | None = None


class WorkerPool:
    """As many worker processes as the settings say, each replaced when it dies.

    Use it as an asynchronous context manager. Its start does not wait for the workers: works
    that come before they are warm stand in line. A work whose worker dies is tried ``attempts``
    times. Where the line would take longer than ``line_seconds``, nobody else may wait in it.
    Processes that are ``launched`` already are taken from there.
    """

    def __init__(
        self,
        settings: Settings,
        attempts: int = 2,
        line_seconds: float = PROMPT_SECONDS,
        launched: list[Launched] | None = None,
    ) -> None:
        self._settings, self._attempts = settings, attempts
        self._line_seconds = line_seconds
        self._launched = launched if launched is not None else []
        self._idle: list[WorkerProcess] = []
        self._line: deque[asyncio.Future[WorkerProcess]] = deque()
        self._line_for_new: deque[asyncio.Future[WorkerProcess]] = deque()
        self._slots: list[asyncio.Task[None]] = []
        self._first_started = asyncio.Event()
        self._usual_seconds = 0.0
        self.warm = 0
        """How many workers are alive and have warmed up."""
        self.draft_problem: str | None = NOT_DRAWN
        """Why drafts cannot be drawn here, as far as is known; ``None`` once one was drawn."""
        self.lost = 0
        """How many workers have died at work, by themselves or at the deadline."""
        self.witness: Witness = _unwitnessed

    @property
    def waiting(self) -> int:
        """How many works stand in line."""
        return len(self._line) + len(self._line_for_new)

    @property
    def busy(self) -> int:
        """How many workers are at work."""
        return max(self.warm - sum(not worker.died.done() for worker in self._idle), 0)

    async def __aenter__(self) -> Self:
        self._slots = [
            asyncio.create_task(self._keep_manned(first=number == 0))
            for number in range(self._settings.workers)
        ]
        return self

    async def __aexit__(self, *_: object) -> None:
        for slot in self._slots:
            slot.cancel()
        await asyncio.gather(*self._slots, return_exceptions=True)

    async def answer(
        self,
        document: bytes,
        options: Options,
        known: frozenset[str] = frozenset(),
        listener: Listener | None = None,
        layout: bytes | None = None,
        shared: bytes | None = None,
        until: float = math.inf,
    ) -> Finished:
        """Answer in a worker process. The ``listener`` hears how the work goes on.

        A stored program's ``layout`` is shown as it is; a posted document's may be ``shared``, if
        an earlier answer has left it. Where the clock of the event loop shows ``until`` before the
        deadline, the work goes by that. Raises what the pipeline raises, and
        `Overloaded`, `DeadlineExceeded`, `WorkerLost`. When the caller is cancelled, work that
        goes on for long is stopped.
        """
        work = Work(options, known, listener is not None, layout, shared)
        reply, pieces, waited = await self._ask(work, document, listener, until)
        return Finished(outcome_of(reply), pieces, waited, reply.stages, shared=reply.shared)

    async def revise(self, document: bytes, layout: bytes | None, change: Change) -> Revised:
        """The next revision of a stored program, made in a worker process. Raises the same."""
        reply, _, _ = await self._ask(Work(ReviseOptions(change), layout=layout), document, None)
        outcome = _unwrap(reply)
        if not isinstance(outcome, Revised):
            raise TypeError("A worker did not revise where it was asked to.")
        return outcome

    async def _ask(
        self,
        work: Work,
        document: bytes,
        listener: Listener | None,
        until: float = math.inf,
    ) -> tuple[Reply, tuple[bytes, ...], float]:
        """A reply, its payload, and the seconds that the work waited for a worker."""
        clock = asyncio.get_running_loop().time
        waited, attempt, wants_new = 0.0, 1, False
        while attempt <= self._attempts:
            came = clock()
            worker = await (self._take_new() if wants_new else self._take(first=attempt > 1))
            began, is_new = clock(), worker.works == 0
            waited += began - came
            stages: tuple[Stage, ...] = ()
            seconds = min(self._settings.deadline_seconds, max(until - began, SOON_OVER))
            try:
                timed = replace(work, seconds=seconds)
                reply, pieces = await self._do(worker, timed, document, listener)
                stages = reply.stages
                self._learn(work.options, reply.outcome)
            except WorkerDiedError:
                self.lost += 1
                log.warning("worker died at work", pid=worker.pid, attempt=attempt)
                attempt += 1
            else:
                if is_new or not reply.ran_out:
                    return reply, pieces, waited
                wants_new = True
            finally:
                took = clock() - began
                self._usual_seconds += 0.1 * (took - self._usual_seconds)
                self.witness(took, stages)
        raise WorkerLost(lost_after(self._attempts))

    async def _do(
        self, worker: WorkerProcess, work: Work, document: bytes, listener: Listener | None
    ) -> tuple[Reply, tuple[bytes, ...]]:
        future = worker.ask(work, document, listener)
        try:
            await asyncio.wait({future}, timeout=self._settings.deadline_seconds)
        except asyncio.CancelledError:
            self._abandon(worker, future, 0.0 if is_slow(work.options) else GRACE_SECONDS)
            raise
        if not future.done():
            worker.kill()
            future.cancel()
            self.lost += 1
            log.warning("worker stopped at the deadline", pid=worker.pid)
            raise DeadlineExceeded(
                f"The work took longer than {self._settings.deadline_seconds:g} seconds."
            )
        reply = future.result()
        self._settle(worker, reply[0])
        return reply

    def _settle(self, worker: WorkerProcess, reply: Reply) -> None:
        """Let it do the next work, or end it; then `_keep_manned` starts another."""
        if reply.is_spent:
            log.info("worker replaced", pid=worker.pid, ran_out=reply.ran_out)
            worker.kill()
        else:
            self._give(worker)

    def _abandon(
        self,
        worker: WorkerProcess,
        future: asyncio.Future[tuple[Reply, tuple[bytes, ...]]],
        grace: float,
    ) -> None:
        """Nobody waits any more: let short work end, which keeps its worker; stop long work."""
        stop = asyncio.get_running_loop().call_later(grace, worker.kill)

        def settle(settled: asyncio.Future[tuple[Reply, tuple[bytes, ...]]]) -> None:
            stop.cancel()
            if settled.exception() is None:
                self._settle(worker, settled.result()[0])

        future.add_done_callback(settle)

    async def _take(self, *, first: bool = False) -> WorkerProcess:
        """A worker with nothing to do; where there is none, stand in line (or ``first`` in it)."""
        while self._idle:
            worker = self._idle.pop()
            if not worker.died.done():
                return worker
        if self._is_line_full() and not first:
            raise Overloaded("All workers are busy and the line is full; try again soon.")
        return await self._stand_in(self._line, first=first)

    async def _take_new(self) -> WorkerProcess:
        """A worker that has not worked yet; it takes the place of the one that was spent."""
        for worker in self._idle:
            if worker.works == 0 and not worker.died.done():
                self._idle.remove(worker)
                return worker
        return await self._stand_in(self._line_for_new)

    async def _stand_in(
        self, line: deque[asyncio.Future[WorkerProcess]], *, first: bool = False
    ) -> WorkerProcess:
        """Wait in a line, or before all others in it."""
        place: asyncio.Future[WorkerProcess] = asyncio.get_running_loop().create_future()
        (line.appendleft if first else line.append)(place)
        try:
            await asyncio.wait({place}, timeout=self._settings.deadline_seconds)
        except asyncio.CancelledError:
            if place.done():
                self._give(place.result())
            else:
                line.remove(place)
            raise
        if not place.done():
            line.remove(place)
            raise Overloaded("No worker became free in time; try again soon.")
        return place.result()

    def _learn(self, options: Options, outcome: Outcome) -> None:
        """Take from each draft that was asked for whether this machine can draw."""
        if not isinstance(options, RenderOptions):
            return
        if options.format is not SceneFormat.PNG or options.quality != "draft":
            return
        if isinstance(outcome, Answer):
            self.draft_problem = None
        elif isinstance(outcome, RendererUnavailable):
            self.draft_problem = str(outcome)

    def _is_line_full(self) -> bool:
        """Whether nobody else should wait."""
        waiting, workers = len(self._line), self._settings.workers
        if waiting >= self._settings.max_waiting:
            return True
        would_take = waiting * self._usual_seconds / workers
        return waiting >= SHORT_LINE * workers and would_take > self._line_seconds

    def _give(self, worker: WorkerProcess) -> None:
        """Hand a worker that has nothing to do to whoever is first in line."""
        if worker.died.done():
            return
        if self._line_for_new and worker.works == 0:
            self._line_for_new.popleft().set_result(worker)
        elif self._line:
            self._line.popleft().set_result(worker)
        else:
            self._idle.append(worker)

    async def _keep_manned(self, *, first: bool) -> None:
        """Start a worker, wait until it dies, start the next; wait longer where starting fails."""
        pause = 0.0
        while True:
            worker = await WorkerProcess.start(self._launched.pop() if self._launched else None)
            try:
                if not first:
                    # Where kernels must be compiled, one does it and the others load them.
                    await self._first_started.wait()
                warmed_up = await self._warmed_up(worker)
                self._first_started.set()
                if warmed_up:
                    pause = 0.0
                    self.warm += 1
                    self._give(worker)
                    await asyncio.shield(worker.died)
                    self.warm -= 1
                else:
                    pause = min(max(2 * pause, 1.0), LONGEST_PAUSE_SECONDS)
            finally:
                await worker.end()
            await asyncio.sleep(pause)

    async def _warmed_up(self, worker: WorkerProcess) -> bool:
        try:
            async with asyncio.timeout(START_SECONDS):
                first = await worker.ready(self._settings)
        except (WorkerDiedError, TimeoutError):
            log.warning("worker did not start", pid=worker.pid)
            return False
        if isinstance(first, Crash):
            log.error("worker did not start", pid=worker.pid, traceback=first.traceback)
            return False
        if first.draft_problem is not None:
            self.draft_problem = first.draft_problem
        log.info("worker ready", pid=worker.pid, draft_problem=first.draft_problem)
        return True


def lost_after(attempts: int) -> str:
    """What is said where so many workers died over the same work."""
    others = {1: "", 2: ", and so did a second one"}
    return (
        "The process that worked on this document died"
        f"{others.get(attempts, f', and so did {attempts - 1} more')}."
    )


def _unwitnessed(_seconds: float, _stages: tuple[Stage, ...]) -> None:
    """Where nobody wants to know."""


def _unwrap(reply: Reply) -> Answer | Unchanged | Revised:
    match reply.outcome:
        case Answer() | Unchanged() | Revised() as outcome:
            return outcome
        case Crash(traceback=traceback):
            raise UnexpectedError(traceback)
        case error:
            raise error


def outcome_of(reply: Reply) -> Answer | Unchanged:
    """What a worker answered. Raises what went wrong."""
    outcome = _unwrap(reply)
    if isinstance(outcome, Revised):
        raise TypeError("A worker revised where nobody had asked for that.")
    return outcome
