"""Many viewers of one program: ``python -m benchmarks.viewers [--viewers 500] [--seconds 60]``.

An editor makes edits at a steady rate; each viewer must hear of every revision, in order, and soon.
One in a hundred is cut off in the middle, and comes back when most of the time is over. Viewers,
editor and service share the machine.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import re
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import numpy as np

from tests.service import SMALL, Service, running_service

PROGRAM = "/v1/programs/watched-by-many"

CUT_SHARE = 0.01
"""Of the viewers."""

_NUMBER = re.compile(rb"^id: (\d+)$", re.MULTILINE)


@dataclass(slots=True)
class Viewer:
    """What a viewer heard: numbers of revisions, and when."""

    numbers: list[int] = field(default_factory=list)
    times: list[float] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Outcome:
    """Seconds from sending an edit until a viewer heard of it, and what was missed."""

    viewers: int
    edits: int
    incomplete: int
    since_sent: np.ndarray[tuple[int], np.dtype[np.float64]]
    edit_seconds: np.ndarray[tuple[int], np.dtype[np.float64]]
    returned: int

    def table(self) -> str:
        """For people."""
        middle, late, worst = np.quantile(self.since_sent, [0.5, 0.99, 1.0]) * 1000
        edit, slow = np.quantile(self.edit_seconds, [0.5, 0.99]) * 1000
        return (
            f"{self.viewers} viewers, {self.edits} edits; {self.incomplete} viewers missed some or "
            f"got some out of order; {self.returned} were cut off and came back\n"
            f"from sending an edit to hearing of it: median {middle:.0f} ms, 99th percentile "
            f"{late:.0f} ms, worst {worst:.0f} ms\n"
            f"answer to the editor: median {edit:.0f} ms, 99th percentile {slow:.0f} ms"
        )


def measure(service: Service, viewers: int, seconds: float, rate: float) -> Outcome:
    """Let so many watch a service for so long at ``rate`` edits a second."""
    return asyncio.run(_measure(service, viewers, seconds, rate))


async def _measure(service: Service, viewers: int, seconds: float, rate: float) -> Outcome:
    async with httpx.AsyncClient(base_url=service.url, timeout=60) as client:
        (await client.put(PROGRAM, json=SMALL)).raise_for_status()
        edits = max(int(seconds * rate), 2)
        heard = [Viewer() for _ in range(viewers)]
        cut = set(range(0, viewers, max(int(1 / CUT_SHARE), 1)))
        leave, back = seconds * 0.2, seconds * 0.8
        tasks = [
            asyncio.create_task(
                _away(service, viewer, edits + 1, leave, back)
                if number in cut
                else _watch(service, viewer, edits + 1)
            )
            for number, viewer in enumerate(heard)
        ]
        while any(not viewer.numbers for viewer in heard):
            await asyncio.sleep(0.05)
        sent, took = await _edit(client, edits, rate)
        await asyncio.wait(tasks, timeout=30)
    wanted = list(range(1, edits + 2))
    since_sent = [
        at - sent[number]
        for place, viewer in enumerate(heard)
        if place not in cut
        for number, at in zip(viewer.numbers, viewer.times, strict=True)
        if number > 1
    ]
    return Outcome(
        viewers,
        edits,
        sum(viewer.numbers != wanted for viewer in heard),
        np.array(since_sent),
        np.array(took),
        len(cut),
    )


async def _edit(
    client: httpx.AsyncClient, edits: int, rate: float
) -> tuple[dict[int, float], list[float]]:
    """When each revision was asked for, and how long the answer took."""
    sent, took = {}, []
    start = time.perf_counter()
    for number in range(edits):
        await asyncio.sleep(max(start + number / rate - time.perf_counter(), 0))
        edit = {"type": "set_item", "id": "y", "fields": {"label": f"Y {number}"}}
        before = time.perf_counter()
        sent[number + 2] = before
        answer = await client.post(f"{PROGRAM}/edits", json={"edits": [edit]})
        answer.raise_for_status()
        took.append(time.perf_counter() - before)
    return sent, took


async def _away(service: Service, viewer: Viewer, last: int, leave: float, back: float) -> None:
    """Watch, be cut off after ``leave`` seconds, and come back after ``back``."""
    try:
        async with asyncio.timeout(leave):
            await _watch(service, viewer, last)
    except TimeoutError:
        await asyncio.sleep(back - leave)
        await _watch(service, viewer, last)


async def _watch(service: Service, viewer: Viewer, last: int) -> None:
    """Hear of revisions up to the ``last``, from the one after the newest that is known."""
    address = urlsplit(service.url)
    reader, writer = await asyncio.open_connection(address.hostname, address.port)
    known = f"Last-Event-ID: {viewer.numbers[-1]}\r\n" if viewer.numbers else ""
    writer.write(f"GET {PROGRAM}/events HTTP/1.1\r\nHost: {address.netloc}\r\n{known}\r\n".encode())
    rest = b""
    try:
        while not viewer.numbers or viewer.numbers[-1] < last:
            piece = await reader.read(65536)
            if not piece:
                return
            now = time.perf_counter()
            whole, _, rest = (rest + piece).rpartition(b"\n\n")
            numbers = [int(number) for number in _NUMBER.findall(whole + b"\n")]
            viewer.numbers.extend(numbers)
            viewer.times.extend([now] * len(numbers))
    finally:
        writer.close()


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--viewers", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=75.0)
    parser.add_argument("--rate", type=float, default=10.0)
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    with (
        tempfile.TemporaryDirectory() as folder,
        running_service(Path(folder), kept_revisions=1000) as service,
    ):
        outcome = measure(service, asked.viewers, asked.seconds, asked.rate)
    if asked.json:
        late = float(np.quantile(outcome.since_sent, 0.99))
        print(json.dumps({"incomplete": outcome.incomplete, "late_seconds": late}))
    else:
        print(outcome.table())


if __name__ == "__main__":
    main()
