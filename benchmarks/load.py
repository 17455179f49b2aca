"""The service under load: ``python -m benchmarks.load [--seconds N] [--quick]``.

Finds the highest rate of a mix of questions, asks at four fifths of it for long, then for more than
the service can do, and last for what is cached. Client and service share the machine.
"""

from __future__ import annotations

import argparse
import asyncio
import itertools
import os
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import psutil

from benchmarks import load_cached, load_tables
from benchmarks.load_client import Client
from benchmarks.load_mix import CLAUSES, Replies, closed_loop, open_loop, questions, renamed
from tests.service import Service, running_service

ASKERS = 8
"""So many at a time keep all workers at work."""

SHARE = 0.8
"""Of the highest rate, at which the service must go on for ever."""

OVERLOAD = 4.0
"""Times the highest rate: more than the service can do."""

LEAST_OVERLOAD = 60.0
"""In a second, so that the line is full within seconds on a slow machine too."""


@dataclass(frozen=True, slots=True)
class Plan:
    """Seconds for each part: of what is cached, for each program and service."""

    search: float
    steady: float
    overload: float
    cached: float
    share: float = SHARE
    programs: Sequence[str] = load_cached.PROGRAMS
    rounds: int = load_cached.ROUNDS


QUICK = Plan(search=3.0, steady=5.0, overload=5.0, cached=3.0)


@dataclass(frozen=True, slots=True)
class Memory:
    """Bytes of the service and of its workers, at a time in seconds since the beginning."""

    at: float
    service: int
    workers: int


@dataclass(frozen=True, slots=True)
class Figures:
    """What was found: the ``highest`` rate in a second, and the seconds of ``recovery``."""

    highest: float
    steady: Replies
    memory: Sequence[Memory]
    overload: Replies
    refusals: Sequence[float]
    """Seconds from each request that was turned away to its answer, as the service saw it."""
    recovery: float
    cached: Sequence[load_cached.Rate]
    busy: float
    """Processes at work or waiting for a core, before anything was asked."""


def measure(plan: Plan) -> Figures:
    """Start a service, do all parts, one after another, and stop it."""
    busy = os.getloadavg()[0]
    with (
        tempfile.TemporaryDirectory() as folder,
        running_service(Path(folder), workers=2) as service,
    ):
        highest, steady, memory, overload, recovery = asyncio.run(_under_load(service, plan))
        refusals = sorted(
            event["ms"] / 1000 for event in service.events() if event.get("status") == 503
        )
        cached = load_cached.measure(service, plan.cached, plan.programs, plan.rounds)
    return Figures(highest, steady, memory, overload, refusals, recovery, cached, busy)


async def _under_load(
    service: Service, plan: Plan
) -> tuple[float, Replies, Sequence[Memory], Replies, float]:
    client = Client(service.url)
    for clause in CLAUSES:
        await client.post("/v1/render", clause)
    await closed_loop(client, questions(1), ASKERS, plan.search / 3)
    searched = await closed_loop(client, questions(2), ASKERS, plan.search)
    highest = len(searched.all) / max(at for _, at, _ in searched.all)
    memory: list[Memory] = []
    watching = asyncio.create_task(_watch(service, memory))
    steady = await open_loop(client, questions(3), plan.share * highest, plan.steady)
    watching.cancel()
    uncached = (each for each in questions(4) if each.kind != "scene, cached")
    ends = time.perf_counter() + plan.overload
    too_much = max(OVERLOAD * highest, LEAST_OVERLOAD)
    overload = await open_loop(client, uncached, too_much, plan.overload)
    usual = steady.seconds("scene")[len(steady.seconds("scene")) // 2]
    for number in itertools.count():
        probe = await client.post("/v1/render", renamed(CLAUSES[0], f"after {number}"))
        if probe.status == 200 and probe.seconds < 2 * usual:
            break
    recovery = time.perf_counter() - ends
    client.close()
    return highest, steady, memory, overload, recovery


async def _watch(service: Service, found: list[Memory]) -> None:
    start = time.perf_counter()
    while True:
        workers = sum(worker.memory_info().rss for worker in service.workers())
        own = psutil.Process(service.process.pid).memory_info().rss
        found.append(Memory(time.perf_counter() - start, own, workers))
        await asyncio.sleep(1.0)


def main() -> int:
    """Measure and print; the exit status tells whether there were errors where none may be."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=900.0, help="at four fifths of the most")
    parser.add_argument(
        "--share",
        type=float,
        default=SHARE,
        help="of the highest rate; that of eight askers in turn is more than what random arrivals "
        "allow without a long line",
    )
    parser.add_argument("--quick", action="store_true", help="some seconds for everything")
    given = parser.parse_args()
    plan = QUICK if given.quick else Plan(15.0, given.seconds, 15.0, 12.0, given.share)
    figures = measure(plan)
    print(load_tables.tables(figures))
    return 1 if load_tables.errors(figures) else 0


if __name__ == "__main__":
    raise SystemExit(main())
