"""What is asked under load: scenes of the ID3 clauses, their numbers, and drafts of them.

Of the scenes some are asked again and again, so that they are cached; everything else has a name of
its own, so that it is not.
"""

from __future__ import annotations

import asyncio
import itertools
import random
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from benchmarks.load_client import Client, Reply

EXAMPLES = Path(__file__).parents[1] / "examples"

CLAUSES = tuple((EXAMPLES / f"id3-clause-{number}.json").read_bytes() for number in (1, 2))

SHARES = {"scene, cached": 0.21, "scene": 0.49, "numbers": 0.20, "draft": 0.10}
"""Seven of ten are scenes, and three of ten of those are cached."""

PATHS = {
    "scene, cached": "/v1/render",
    "scene": "/v1/render",
    "numbers": "/v1/layout",
    "draft": "/v1/render?format=png",
}


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked, and of which kind it is."""

    kind: str
    path: str
    body: bytes


def questions(seed: int) -> Iterator[Question]:
    """Without end; other seeds have other documents."""
    choices = random.Random(seed)
    kinds, weights = list(SHARES), list(SHARES.values())
    for number in itertools.count():
        (kind,) = choices.choices(kinds, weights)
        document = choices.choice(CLAUSES)
        if kind != "scene, cached":
            document = renamed(document, f"{seed} {number}")
        yield Question(kind, PATHS[kind], document)


def renamed(document: bytes, name: str) -> bytes:
    """The same program by another name."""
    before, rest = document.split(b'"name": "', 1)
    return before + b'"name": "' + name.encode() + b" " + rest


@dataclass(slots=True)
class Replies:
    """What came back, by the kind of the question, and when, in seconds since the beginning."""

    all: list[tuple[str, float, Reply]] = field(default_factory=list)

    def seconds(self, kind: str | None = None, status: int = 200) -> list[float]:
        """How long those took that got this status, sorted."""
        return sorted(
            reply.seconds
            for of, _, reply in self.all
            if reply.status == status and kind in {None, of}
        )

    def count(self, status: int) -> int:
        """How many got it."""
        return sum(reply.status == status for _, _, reply in self.all)


async def closed_loop(
    client: Client, asked: Iterator[Question], askers: int, seconds: float
) -> Replies:
    """So many ask one question after another, each as soon as the one before is answered."""
    replies, start = Replies(), time.perf_counter()

    async def ask_on() -> None:
        while time.perf_counter() < start + seconds:
            question = next(asked)
            reply = await client.post(question.path, question.body)
            replies.all.append((question.kind, time.perf_counter() - start, reply))

    await asyncio.gather(*(ask_on() for _ in range(askers)))
    return replies


async def open_loop(
    client: Client, asked: Iterator[Question], rate: float, seconds: float, seed: int = 0
) -> Replies:
    """So many questions in a second, at random times, whether those before are answered or not."""
    replies, start = Replies(), time.perf_counter()
    gaps = random.Random(seed)
    at = start
    running: set[asyncio.Task[None]] = set()

    async def ask(question: Question, due: float) -> None:
        reply = await client.post(question.path, question.body, due)
        replies.all.append((question.kind, due - start, reply))

    while (at := at + gaps.expovariate(rate)) < start + seconds:
        if (pause := at - time.perf_counter()) > 0:
            await asyncio.sleep(pause)
        # The next is due at its time even where this process is late: waiting counts.
        task = asyncio.create_task(ask(next(asked), at))
        running.add(task)
        task.add_done_callback(running.discard)
    if running:
        await asyncio.wait(running)
    return replies
