"""The real service, in a process of its own, for tests that speak HTTP."""

from __future__ import annotations

import json
import os
import random
import re
import secrets
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import httpx
import psutil

Found = TypeVar("Found")

PATIENCE_SECONDS = 240.0
"""For what should take a second or two, on a busy machine that compiles kernels for the first time:
that alone may take minutes."""


@dataclass(frozen=True)
class Service:
    """A running service: where it listens, its process, and where its log goes."""

    url: str
    process: subprocess.Popen[bytes]
    log: Path

    def client(self) -> httpx.Client:
        """A client with patience."""
        return httpx.Client(base_url=self.url, timeout=PATIENCE_SECONDS)

    def kill(self) -> None:
        """``kill -9``, and wait until it is gone."""
        self.process.kill()
        self.process.wait(PATIENCE_SECONDS)

    def events(self) -> list[dict[str, Any]]:
        """The lines of its log."""
        lines = self.log.read_text().splitlines()
        return [json.loads(line) for line in lines if line.startswith("{")]

    def workers(self) -> list[psutil.Process]:
        """Its worker processes."""
        children = psutil.Process(self.process.pid).children()
        return [child for child in children if is_worker(child)]

    def spent(self) -> dict[int, float]:
        """CPU seconds of its workers by process, once none of them computes."""
        found: dict[int, float] = {}
        while found != (now := {each.pid: cpu_seconds(each) for each in self.workers()}):
            found = now
            time.sleep(0.3)
        return found

    @contextmanager
    def held(self) -> Iterator[None]:
        """None of its workers computes, be it on the quickest machine, until the block ends."""
        held = self.workers()
        for worker in held:
            worker.suspend()
        try:
            yield
        finally:
            for worker in held:
                worker.resume()

    def computed(self) -> float:
        """CPU seconds of the service and its workers so far."""
        return sum(map(cpu_seconds, (psutil.Process(self.process.pid), *self.workers())))

    def busy_worker(self, spent: dict[int, float]) -> psutil.Process | None:
        """The worker that has computed since ``spent`` (CPU seconds by process) was noted."""
        for worker in self.workers():
            if cpu_seconds(worker) - spent.get(worker.pid, 0.0) > 0.2:
                return worker
        return None


def is_worker(process: psutil.Process) -> bool:
    """Whether it is a worker of a service or of a pool, and has not ended."""
    try:
        return "app.jobs.worker" in process.cmdline()
    except psutil.NoSuchProcess:  # or a zombie, which is one of these
        return False


def cpu_seconds(process: psutil.Process) -> float:
    """What it has computed so far."""
    try:
        times = process.cpu_times()
    except psutil.NoSuchProcess:  # or a zombie, which is one of these
        return 0.0
    return float(times.user + times.system)


def spent_until_gone(process: psutil.Process) -> float:
    """CPU seconds that it computes from now on until it has ended.

    On a busy machine they say more than a clock does about how soon it was stopped.
    """
    before = spent = cpu_seconds(process)

    def is_gone() -> bool:
        nonlocal spent
        spent = max(spent, cpu_seconds(process))
        return gone(process)

    until(is_gone)
    return spent - before


def gone(process: psutil.Process) -> bool:
    """Whether it has ended, even if nobody has taken note of that yet."""
    try:
        return bool(process.status() == psutil.STATUS_ZOMBIE)
    except psutil.NoSuchProcess:
        return True


def until(
    find: Callable[[], Found | None], seconds: float = PATIENCE_SECONDS, pause: float = 0.01
) -> Found:
    """What ``find`` finds, as soon as it is true; it is asked again after each ``pause``."""
    end = time.monotonic() + seconds
    while not (found := find()):
        assert time.monotonic() < end, f"not within {seconds} s"
        time.sleep(pause)
    return found


@contextmanager
def running_service(folder: Path, **settings: object) -> Iterator[Service]:
    """A service with ``settings``; on a free port unless ``port`` is among them.

    It has one worker if they say nothing else: each takes seconds to start. Those are waited for,
    unless ``warm`` among the settings is false.
    """
    log = folder / "service.log"
    port, warm = str(settings.pop("port", 0)), settings.pop("warm", True)
    asked: dict[str, Any] = {"workers": 1} | settings
    environment = {f"TUBELOOM_{name.upper()}": str(value) for name, value in asked.items()}
    with log.open("wb") as sink:
        process = subprocess.Popen(
            [sys.executable, "-m", "app", "serve", "--port", port],
            env={
                **os.environ,
                "TUBELOOM_LOG_FORMAT": "json",
                "TUBELOOM_DATA_FOLDER": str(folder / "data"),
                **environment,
            },
            stderr=sink,
        )
    try:
        address = re.compile(r"running on (http://[0-9.:]+)")
        found = until(lambda: address.search(log.read_text()) or process.poll())
        assert isinstance(found, re.Match), log.read_text()
        service = Service(found[1], process, log)
        until(lambda: not warm or _ready(service) >= asked["workers"], pause=0.05)
        yield service
    finally:
        end(process)


def end(process: subprocess.Popen[Any]) -> None:
    """Ask a process to end; where it does not, end it, and say so."""
    process.terminate()
    try:
        process.wait(PATIENCE_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait(PATIENCE_SECONDS)
        raise


def _ready(service: Service) -> int:
    """How many workers are warm. To ask at /readyz would have one of them draw."""
    return sum(event["event"] == "worker ready" for event in service.events())


SMALL: dict[str, Any] = {
    "name": "A relation of three",
    "items": [{"id": "x", "label": "X"}, {"id": "y"}, {"id": "z", "label": "Z"}],
    "hyperedges": [{"id": "e", "attachments": [{"item": "x"}, {"item": "y"}, {"item": "z"}]}],
}
"""A program that is quick to render."""


def fresh(name: str) -> str:
    """A name that nobody has used: what was answered to others is no answer to who uses it."""
    return f"{name} {secrets.token_hex(8)}"


def large_program(items: int) -> bytes:
    """A program that keeps a worker busy: so many labels, and a relation of each three of them.

    Each call gives another, which no service has seen.
    """
    names = [f"{number:05}" for number in range(items)]
    return json.dumps(
        {
            "name": fresh("Large"),
            "items": [{"id": name, "label": name} for name in names],
            "hyperedges": [
                {"id": first, "attachments": [{"item": first}, {"item": second}, {"item": third}]}
                for first, second, third in zip(names, names[1:], names[2:], strict=False)
            ],
        }
    ).encode()


def wide_program(hyperedges: int) -> bytes:
    """A program whose scene is large: long tubes across a thousand items. None is like another."""
    choices = random.Random(1)
    names = [str(number) for number in range(1000)]
    return json.dumps(
        {
            "name": fresh("Wide"),
            "items": [{"id": name} for name in names],
            "hyperedges": [
                {
                    "id": str(number),
                    "attachments": [{"item": name} for name in choices.sample(names, 5)],
                }
                for number in range(hyperedges)
            ],
        }
    ).encode()
