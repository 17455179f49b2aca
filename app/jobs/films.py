"""The work of a job: one work, or for films of final pictures several that are done side by side.

A film is drawn in stretches of frames, each a work that is tried again by itself; the frames are
encoded by one work at the end, so that the film is the same to the byte as one drawn in one piece.
"""

from __future__ import annotations

import asyncio
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import count, pairwise

from app.answers import Answer, JoinOptions, Options, RenderOptions, Stretch
from app.errors import WorkerLost
from app.jobs.crew import Crew
from app.jobs.executor import Finished, lost_after
from app.jobs.process import Listener
from app.jobs.running import Running
from app.jobs.work import Report, Stage

STRETCHES_FOR_EACH = 3
"""For each who works: so that nobody is idle for long at the end, and little is done again where
one is lost."""

FEWEST_FRAMES = 2
"""In a stretch: each builds the scene anew."""

DRAWN = 0.95
"""Share of the whole work that is done when all frames are drawn."""


@dataclass(frozen=True, slots=True)
class Works:
    """Does the works of a ``running`` task with a ``crew``; each is tried ``most`` times.

    All are over when the clock of the event loop shows ``until``.
    """

    crew: Crew
    running: Running
    most: int
    until: float = math.inf

    async def all(self, listener: Listener) -> Finished:
        """What the task asks for. Raises what the pipeline raises, and `WorkerLost`."""
        task = self.running.task
        parts = stretches(task.options, self.crew.width)
        if len(parts) < 2:
            return await self._one(task.document, task.options, listener, task.layout)
        shares = [0.0] * len(parts)

        def listen(number: int, report: Report, _preview: bytes) -> None:
            shares[number] = max(shares[number], report.share)
            done = sum(
                share * (part.end - part.first) for share, part in zip(shares, parts, strict=True)
            )
            listener(Report(report.stage, DRAWN * done / task.options.frames), b"")

        works = [
            asyncio.create_task(
                self._one(
                    task.document,
                    replace(task.options, stretch=part),
                    partial(listen, number),
                    task.layout,
                )
            )
            for number, part in enumerate(parts)
        ]
        try:
            drawn = await asyncio.gather(*works)
        finally:
            for work in works:
                work.cancel()
            await asyncio.gather(*works, return_exceptions=True)
        frames = await asyncio.to_thread(_together, drawn)
        encoded = await self._one(
            frames,
            JoinOptions(task.options),
            lambda report, _preview: listener(
                Report(report.stage, DRAWN + (1.0 - DRAWN) * report.share), b""
            ),
            None,
        )
        return _film(drawn, encoded)

    async def _one(
        self, document: bytes, options: Options, listener: Listener, layout: bytes | None
    ) -> Finished:
        for attempt in count(self.running.task.attempts):
            self.running.attempts = max(self.running.attempts, attempt)
            try:
                return await self.crew.answer(document, options, listener, layout, self.until)
            except WorkerLost:
                if attempt >= self.most:
                    raise WorkerLost(lost_after(self.most)) from None
                listener(Report("starting again", 0.0), b"")
        raise AssertionError("there is always another attempt")


def stretches(options: RenderOptions, width: int) -> Sequence[Stretch]:
    """The parts of a film that ``width`` workers draw; none where it is not worth it.

    >>> [(part.first, part.end) for part in stretches(RenderOptions(), 2)]
    []
    """
    if width < 2 or not (options.format.is_animated and options.quality == "final"):
        return ()
    number = min(STRETCHES_FOR_EACH * width, options.frames // FEWEST_FRAMES)
    bounds = [round(options.frames * part / number) for part in range(number + 1)]
    return [
        Stretch(first, end, min(width * (end - first) / options.frames, 1.0))
        for first, end in pairwise(bounds)
    ]


def _together(drawn: Sequence[Finished]) -> bytes:
    return b"".join(piece for finished in drawn for piece in finished.pieces)


def _film(drawn: Sequence[Finished], encoded: Finished) -> Finished:
    """The encoded film, and what is to be said of how its frames were drawn."""
    answers = [_answer(finished) for finished in drawn]
    etags = {answer.etag for answer in answers}
    notes = dict(answers[0].notes)
    if notes:
        ended = [answer.notes["Stopped-By"] for answer in answers]
        notes |= {
            "Samples": str(min(int(answer.notes["Samples"]) for answer in answers)),
            "Noise": max((answer.notes["Noise"] for answer in answers), key=float),
            "Stopped-By": "time limit" if "time limit" in ended else ended[0],
        }
    seconds: Counter[str] = Counter()
    for finished in (*drawn, encoded):
        for stage in finished.stages:
            seconds[stage.name] += stage.seconds  # type: ignore[assignment]
    answer = replace(
        _answer(encoded),
        etag=etags.pop() if len(etags) == 1 else None,
        name=answers[0].name,
        notes=notes,
    )
    return replace(
        encoded,
        answer=answer,
        waited=max(finished.waited for finished in drawn),
        stages=tuple(Stage(name, total) for name, total in seconds.items()),
    )


def _answer(finished: Finished) -> Answer:
    if not isinstance(finished.answer, Answer):
        raise TypeError("A worker knew an answer that nobody had.")
    return finished.answer
