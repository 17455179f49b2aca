"""Writers who race, and a service that is killed: ``python -m benchmarks.writers``.

Two writers count up one number in a stored program, each with If-Match, so often in all; none of
their changes may get lost. Then the service is killed again and again while a writer writes; what
was acknowledged must be there after each start, and nothing by halves.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import httpx

from app.store import programs
from app.store.database import Database
from tests.postgres import running_postgres
from tests.service import SMALL, Service, running_service

COUNTER = "/v1/programs/counter"


@dataclass(frozen=True, slots=True)
class Race:
    """``count`` is what the number came to, ``refused`` how often a writer came too late."""

    writes: int
    count: int
    refused: int
    revisions: int
    seconds: float

    def line(self, name: str) -> str:
        """For people."""
        return (
            f"{name}: {self.writes} writes, counted {self.count}, newest revision "
            f"{self.revisions}, {self.refused} refused with 412, {self.seconds:.1f} s"
        )


def race(service: Service, writes: int) -> Race:
    """Let two writers make so many ``writes`` together."""
    with service.client() as client:
        client.put(COUNTER, json=SMALL | {"data": {"count": 0}}).raise_for_status()
        before = time.perf_counter()
        with ThreadPoolExecutor(2) as writers:
            halves = [writes // 2, writes - writes // 2]
            refused = sum(writers.map(partial(_count_up, service), halves))
        seconds = time.perf_counter() - before
        end = client.get(COUNTER)
        newest = int(end.headers["tubeloom-revision"])
        return Race(writes, int(end.json()["data"]["count"]), refused, newest, seconds)


def _count_up(service: Service, times: int) -> int:
    """How often somebody else was first."""
    refused = 0
    with service.client() as client:
        for _ in range(times):
            while True:
                got = client.get(COUNTER)
                count = got.json()["data"]["count"] + 1
                answer = client.patch(
                    COUNTER,
                    content=f'{{"data": {{"count": {count}}}}}',
                    headers={
                        "Content-Type": "application/merge-patch+json",
                        "If-Match": got.headers["etag"],
                    },
                )
                if answer.status_code != 412:
                    answer.raise_for_status()
                    break
                refused += 1
    return refused


@dataclass(frozen=True, slots=True)
class Survival:
    """``acknowledged`` writes, of which some are ``lost``; revisions that are ``broken``."""

    writes: int
    kills: int
    acknowledged: int
    lost: int
    broken: int

    def line(self, name: str) -> str:
        """For people."""
        return (
            f"{name}: {self.writes} writes, {self.kills} times kill -9; {self.acknowledged} "
            f"acknowledged, {self.lost} of them lost, {self.broken} revisions by halves"
        )


def survive(
    writes: int,
    kills: int,
    database: str | None = None,
    seed: int = 1,
    before: Callable[[Service], object] | None = None,
) -> Survival:
    """Write so often, while the service is killed at random points of it and started again.

    The first of these services is good for what is done ``before``.
    """
    moments = random.Random(seed)
    left = writes
    acknowledged: dict[int, str] = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        url = database or f"sqlite:///{folder / 'programs.db'}"
        for round_number in range(kills + 1):
            share = left if round_number == kills else min(writes // (kills + 1), left)
            with running_service(folder, workers=1, database=url) as service:
                if lost := _lost(url, acknowledged):
                    return Survival(writes, round_number, len(acknowledged), lost, 0)
                if before is not None and round_number == 0:
                    before(service)
                if round_number < kills:
                    delay = moments.uniform(0.05, 0.03 * share)
                    threading.Timer(delay, service.process.kill).start()
                left -= _write(service, share, acknowledged, writes - left)
                service.process.kill()
        lost = _lost(url, acknowledged)
        return Survival(writes, kills, len(acknowledged), lost, _broken(url))


def _write(service: Service, share: int, acknowledged: dict[int, str], begin: int) -> int:
    """How many writes were sent; each is a program of its own, then edited."""
    sent = 0
    with service.client() as client, suppress(httpx.TransportError):
        for number in range(begin, begin + share):
            sent += 1
            path = f"/v1/programs/p{number // 4}"
            if number % 4 == 0:
                answer = client.put(path, json=SMALL | {"data": {"writes": []}})
            else:
                item = {"id": f"w{number}", "label": f"Write {number}"}
                edit = {"type": "add_item", "item": item}
                answer = client.post(f"{path}/edits", json={"edits": [edit]})
            if answer.status_code == 404:  # the write that made the program was not acknowledged
                continue
            answer.raise_for_status()
            acknowledged[number] = path
    return sent


def _lost(url: str, acknowledged: dict[int, str]) -> int:
    """How many of the acknowledged writes are not there."""
    database = Database(url)
    try:
        documents = {
            path: database.do(partial(programs.load, program=path.rpartition("/")[2]))
            for path in set(acknowledged.values())
        }
    finally:
        database.close()
    lost = 0
    for number, path in acknowledged.items():
        content = documents[path]
        document = {} if content is None else json.loads(content.document)
        items = {item["id"] for item in document.get("items", ())}
        lost += not (items if number % 4 == 0 else f"w{number}" in items)
    return lost


def _broken(url: str) -> int:
    """How many revisions are not what their digests say, or have no head."""
    database = Database(url)
    try:
        broken = 0
        for listed in database.do(lambda connection: programs.listing(connection, None, 10**6)):
            kept = database.do(partial(programs.kept_after, program=listed.id, number=0))
            numbers = [record.number for record in kept]
            broken += numbers != list(range(numbers[0], listed.revision + 1))
            for record in kept:
                content = database.do(
                    partial(programs.load, program=listed.id, number=record.number)
                )
                whole = content is not None and record.digest == (
                    hashlib.sha256(content.document + content.layout).hexdigest()
                )
                broken += not whole
        return broken
    finally:
        database.close()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--races", type=int, default=1000)
    parser.add_argument("--writes", type=int, default=200)
    parser.add_argument("--kills", type=int, default=10)
    asked = parser.parse_args()
    with running_postgres() as server:
        databases = {"SQLite": None, "PostgreSQL": server.url}
        for name, url in databases.items():
            with tempfile.TemporaryDirectory() as folder:
                given = {} if url is None else {"database": url}
                with running_service(Path(folder), workers=2, **given) as service:
                    print(race(service, asked.races).line(name), flush=True)
        for name, url in databases.items():
            print(survive(asked.writes, asked.kills, url).line(name), flush=True)


if __name__ == "__main__":
    main()
