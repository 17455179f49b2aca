"""How many cached answers a second, beside bare routes that read the body and answer as much.

`wrk` asks where there is one; else a small client of our own, which is slower and says so.
"""

from __future__ import annotations

import asyncio
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import httpx
import psutil

from benchmarks.load_client import Client
from benchmarks.load_mix import EXAMPLES
from tests.service import Service, until

PROGRAMS = ("hello", "id3-clause-1", "id3-clause-2")

CONNECTIONS = 8

ROUNDS = 3
"""The services take turns, so that whatever else the machine does disturbs all of them."""

SCRIPT = """
local file = io.open(os.getenv("DOCUMENT"), "rb")
wrk.body = file:read("*a")
file:close()
wrk.method = "POST"
wrk.headers["Content-Type"] = "application/json"
"""


@dataclass(frozen=True, slots=True)
class Rate:
    """Answers of one size from one service: most in a second, and least CPU time for each."""

    program: str
    size: int
    who: str
    per_second: float
    cpu_seconds: float


def measure(
    service: Service, seconds: float, programs: Sequence[str], rounds: int
) -> Sequence[Rate]:
    """The rates of some ``programs``' scenes, each measured for so many ``seconds``."""
    found = []
    for program in programs:
        document = EXAMPLES / f"{program}.json"
        answer = httpx.post(f"{service.url}/v1/render", content=document.read_bytes(), timeout=60)
        size = len(answer.content)
        with bare_service("starlette", size) as starlette, bare_service("fastapi", size) as fastapi:
            asked = {
                "Tubeloom": (service.url, service.process.pid),
                "bare Starlette": starlette,
                "bare FastAPI": fastapi,
            }
            best = dict.fromkeys(asked, (0.0, 1.0))
            for _ in range(rounds):
                for who, (url, pid) in asked.items():
                    rate, cpu = _ask(url, pid, document, seconds / rounds)
                    best[who] = max(best[who][0], rate), min(best[who][1], cpu)
        found += [Rate(program, size, who, *figures) for who, figures in best.items()]
    return found


@contextmanager
def bare_service(kind: str, size: int) -> Iterator[tuple[str, int]]:
    """One whose route reads the body and answers so many bytes; its URL and process."""
    with tempfile.TemporaryFile("w+") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "benchmarks.bare_service", kind, str(size)], stderr=log
        )
        try:
            url = until(lambda: _address(log))
            yield url, process.pid
        finally:
            process.terminate()
            process.wait()


def _address(log: IO[str]) -> str | None:
    log.seek(0)
    found = re.search(r"running on (http://[0-9.:]+)", log.read())
    return found and found[1]


def _ask(url: str, pid: int, document: Path, seconds: float) -> tuple[float, float]:
    """Answers in a second, and CPU seconds of the process for each."""
    before = _cpu_seconds(pid)
    asks = _wrk if shutil.which("wrk") else _own
    answers, took = asks(f"{url}/v1/render", document, seconds)
    return answers / took, (_cpu_seconds(pid) - before) / answers


def _wrk(url: str, document: Path, seconds: float) -> tuple[int, float]:
    whole = max(round(seconds), 1)
    with tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
        script.write(SCRIPT)
        script.flush()
        said = subprocess.run(
            ["wrk", "-t1", f"-c{CONNECTIONS}", f"-d{whole}s", "-s", script.name, url],
            env={**os.environ, "DOCUMENT": str(document)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    if "Non-2xx" in said or "Socket errors" in said:
        raise RuntimeError(said)
    found = re.search(r"(\d+) requests in ([0-9.]+)(ms|s|m)", said)
    assert found is not None, said
    return int(found[1]), float(found[2]) * {"ms": 0.001, "s": 1, "m": 60}[found[3]]


def _own(url: str, document: Path, seconds: float) -> tuple[int, float]:
    body = document.read_bytes()
    answers = 0

    async def ask_on(client: Client, end: float) -> None:
        nonlocal answers
        while time.perf_counter() < end:
            reply = await client.post("/v1/render", body)
            if reply.status != 200:
                raise RuntimeError(f"answered {reply.status}")
            answers += 1

    async def ask() -> float:
        client, began = Client(url), time.perf_counter()
        await asyncio.gather(*(ask_on(client, began + seconds) for _ in range(CONNECTIONS)))
        client.close()
        return time.perf_counter() - began

    took = asyncio.run(ask())
    return answers, took


def _cpu_seconds(pid: int) -> float:
    times = psutil.Process(pid).cpu_times()
    return float(times.user + times.system)
