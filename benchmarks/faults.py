"""What becomes of jobs when parts of the service are killed: ``python -m benchmarks.faults``.

A scheduler, two workers, a service and a real PostgreSQL on this machine; `kill -9` of a worker, of
the scheduler and of PostgreSQL while 20 jobs are worked on. Then a film of 36 final frames: by one
worker, by two, and by two of which one is killed midway, each worker bound to one core. Some
minutes; the exit status is 0 where everything held.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event
from typing import Any

import httpx

from tests.api.job_calls import OVER, program, start
from tests.cluster import Cluster, running_cluster
from tests.postgres import Postgres, running_postgres
from tests.service import Service, running_service

JOBS, DOCUMENTS = 20, 15
PICTURE = "format=png&quality=final&width=160&height=120&samples=64"

FRAMES = 36
FILM = f"format=webp&quality=final&width=240&height=180&samples=16&frames={FRAMES}"

PATIENCE_SECONDS = 420.0
"""For all jobs of one part; what takes longer counts as lost."""


@dataclass
class Watch:
    """What was seen of jobs while they were worked on."""

    client: httpx.Client
    jobs: list[str]
    ended: dict[str, dict[str, Any]] = field(default_factory=dict)
    first_results: dict[str, bytes] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def look(self) -> None:
        """See how all jobs are; what was over must stay as it was."""
        for job in self.jobs:
            try:
                response = self.client.get(job)
            except httpx.TransportError as error:
                self.faults.append(f"no answer: {error!r}")
                continue
            if response.status_code == 503:
                continue
            now = response.json()
            before = self.ended.get(job)
            if before is not None and now != before:
                self.faults.append(f"{job} was {before['state']} and became something else")
            if before is None and now["state"] in OVER:
                self.ended[job] = now

    def until(self, enough: Callable[[], bool], seconds: float = PATIENCE_SECONDS) -> bool:
        """Whether it came to that in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.look()
            if enough():
                return True
            time.sleep(0.2)
        return False


def main() -> int:
    """Print both tables; 1 where something did not hold."""
    load = os.getloadavg()[0]
    print(f"{os.cpu_count()} cores, load {load:.1f} before.\n")
    folder = Path(tempfile.mkdtemp(prefix="tubeloom-faults-"))
    with running_postgres() as postgres:
        faults = kills(folder / "kills", postgres)
    faults += films(folder / "films")
    for fault in faults:
        print(f"FAULT: {fault}")
    return 1 if faults else 0


def kills(folder: Path, postgres: Postgres) -> list[str]:
    """20 jobs, three kills."""
    folder.mkdir()
    with (
        running_cluster(folder / "cluster") as cluster,
        running_service(
            folder, workers=1, database=postgres.url, dask_scheduler=cluster.address
        ) as service,
        service.client() as client,
        watching_health(service) as health,
    ):
        began = time.monotonic()
        jobs = [start(client, PICTURE, program(f"job {n % DOCUMENTS}")) for n in range(JOBS)]
        watch = Watch(client, jobs)
        deeds: list[tuple[str, int, Callable[[], None]]] = [
            ("a worker", 3, lambda: cluster.kill_worker(0)),
            ("the scheduler", 7, cluster.kill_scheduler),
            ("PostgreSQL, which starts again after 3 s", 11, lambda: _bounce(postgres)),
        ]
        print("| killed | after | next job done after |\n|---|--:|--:|")
        for name, done, deed in deeds:
            if not watch.until(lambda done=done: len(watch.ended) >= done):  # type: ignore[misc]
                watch.faults.append(f"{done} jobs were not over in time")
                break
            before, at = len(watch.ended), time.monotonic()
            deed()
            watch.until(lambda before=before: len(watch.ended) > before)  # type: ignore[misc]
            print(f"| {name} | {at - began:.1f} s | {time.monotonic() - at:.1f} s |", flush=True)
        watch.until(lambda: len(watch.ended) == JOBS)
        seconds = time.monotonic() - began
        return _verdict(watch, client, service, seconds) + health.faults(seconds)


def _verdict(watch: Watch, client: httpx.Client, service: Service, seconds: float) -> list[str]:
    states = Counter(found["state"] for found in watch.ended.values())
    attempts = Counter(found["attempts"] for found in watch.ended.values())
    print(
        f"\n{JOBS} jobs of {DOCUMENTS} documents: {dict(states)} in {seconds:.0f} s; "
        f"attempts {dict(attempts)}."
    )
    faults = list(watch.faults)
    faults += [f"{job} never ended" for job in watch.jobs if job not in watch.ended]
    made: dict[int, set[bytes]] = {}
    for number, job in enumerate(watch.jobs):
        found = watch.ended.get(job, {})
        if found.get("state") == "failed" and not found.get("problem"):
            faults.append(f"{job} failed without saying why")
        if found.get("state") == "done":
            result = client.get(f"{job}/result")
            if result.status_code != 200:
                faults.append(f"{job} is done, but its result answers {result.status_code}")
            made.setdefault(number % DOCUMENTS, set()).add(result.content)
    faults += [
        f"document {name} has {len(all_)} results" for name, all_ in made.items() if len(all_) > 1
    ]
    if service.process.poll() is not None:
        faults.append("the service ended")
    return faults


def _bounce(postgres: Postgres) -> None:
    postgres.kill()
    time.sleep(3.0)
    postgres.start()


def films(folder: Path) -> list[str]:
    """A film by one worker, by two, and by two of which one is killed."""
    cores = sorted(os.sched_getaffinity(0))
    if len(cores) < 2:
        print("A film by two workers needs two cores.")
        return []
    one, two = frozenset({cores[0]}), frozenset({cores[1]})
    alone, _, _ = _film(folder / "one", (one,), kill=False)
    both, first, second = _film(folder / "two", (one, two), kill=True)
    print(f"\n| {FRAMES} final frames of 240 by 180 | |\n|---|--:|")
    print(f"| one worker | {alone[0]:.1f} s |")
    print(f"| two workers | {first:.1f} s, {alone[0] / first:.2f} times as fast |")
    print(f"| two workers, one killed midway | {second:.1f} s |")
    made = {alone[1], *both[1:]}
    return [] if len(made) == 1 else [f"{len(made)} different films came of one document"]


def _film(
    folder: Path, cores: tuple[frozenset[int], ...], *, kill: bool
) -> tuple[tuple[Any, ...], float, float]:
    """Seconds and bytes of a film; and where one worker is killed, of another beside it."""
    folder.mkdir(parents=True)
    with (
        running_cluster(folder / "cluster", cores=cores) as cluster,
        running_service(folder, workers=1, dask_scheduler=cluster.address) as service,
        service.client() as client,
    ):
        _warm(client, cluster, len(cores))
        first, film = _timed(client, b"", None)
        if not kill:
            return (first, film), first, 0.0
        second, again = _timed(client, b" ", lambda: cluster.kill_worker(0))
        return (first, film, again), first, second


def _warm(client: httpx.Client, cluster: Cluster, workers: int) -> None:
    """Let every worker draw once."""
    query = "format=png&quality=final&width=64&height=48&samples=256"
    number = 0
    while len(cluster.children()) < workers or number < 2 * workers:
        jobs = [start(client, query, program(f"warm {number + n}")) for n in range(workers)]
        number += workers
        watch = Watch(client, jobs)
        watch.until(lambda watch=watch: len(watch.ended) == len(watch.jobs))  # type: ignore[misc]


def _timed(
    client: httpx.Client, tail: bytes, midway: Callable[[], None] | None
) -> tuple[float, bytes]:
    document = json.dumps(program("film")).encode() + tail
    began = time.monotonic()
    job = start(client, FILM, document)
    watch = Watch(client, [job])
    if midway is not None:
        watch.until(lambda: client.get(job).json()["share"] > 0.5)
        midway()
    if not watch.until(lambda: bool(watch.ended)) or watch.ended[job]["state"] != "done":
        raise SystemExit(f"The film was not made: {watch.ended.get(job)}")
    seconds = time.monotonic() - began
    film = client.get(f"{job}/result").content
    if film.count(b"ANMF") != FRAMES:
        raise SystemExit(f"The film has {film.count(b'ANMF')} frames, not {FRAMES}.")
    return seconds, film


@dataclass
class Health:
    """How a service answered all the time."""

    waits: list[float] = field(default_factory=list)
    refused: int = 0

    def faults(self, seconds: float) -> list[str]:
        """What was wrong with that; prints what was seen."""
        print(
            f"`/healthz` answered {len(self.waits)} times in {seconds:.0f} s, at the longest after "
            f"{1000 * max(self.waits):.0f} ms; {self.refused} times not."
        )
        return [f"/healthz did not answer {self.refused} times"] if self.refused else []


@contextmanager
def watching_health(service: Service) -> Iterator[Health]:
    """Ask ten times a second whether the service lives."""
    health, end = Health(), Event()

    def ask() -> None:
        with service.client() as client:
            while not end.wait(0.1):
                began = time.monotonic()
                try:
                    client.get("/healthz").raise_for_status()
                except httpx.HTTPError:
                    health.refused += 1
                health.waits.append(time.monotonic() - began)

    with ThreadPoolExecutor(1) as background:
        asking = background.submit(ask)
        try:
            yield health
        finally:
            end.set()
            asking.result()


if __name__ == "__main__":
    sys.exit(main())
