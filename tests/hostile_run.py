"""Sends hostile requests to a service, and notes how it bears them."""

from __future__ import annotations

import json
import time
from collections import Counter, defaultdict
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from http.client import HTTPConnection

import psutil

from tests.cost import cost_of_good_document
from tests.hostile import Hostile, described
from tests.hostile_changes import VICTIM, VICTIM_PATH
from tests.service import PATIENCE_SECONDS, SMALL, Service

LONGEST_SECONDS = 1.0
"""Whatever takes longer is compared with a good document that takes about as long."""

LARGEST_ANSWER = 100_000
"""In bytes; whoever sends a bomb must not get one."""

ATTEMPTS = 3
"""What is slow three times, each time slower than a good document right after it, is slow."""

HEALTHY_EVERY = 25
"""Requests after which something good is asked."""


@dataclass
class Report:
    """What came of an attack."""

    faults: list[str] = field(default_factory=list)
    statuses: Counter[int] = field(default_factory=Counter)
    seconds: dict[str, list[float]] = field(default_factory=lambda: defaultdict(list))
    memory: list[int] = field(default_factory=list)
    """Of the service and its workers together, in bytes, now and then."""

    def table(self) -> str:
        """How long each kind took, as Markdown."""
        lines = ["| kind | requests | median ms | longest ms |", "|---|--:|--:|--:|"]
        for kind, took in sorted(self.seconds.items()):
            middle = sorted(took)[len(took) // 2]
            lines.append(f"| {kind} | {len(took)} | {middle * 1000:.1f} | {max(took) * 1000:.0f} |")
        return "\n".join(lines)


def attack(service: Service, requests: Iterable[Hostile]) -> Report:
    """Send all ``requests``, one after another."""
    report = Report()
    victim = _victim(service, "PUT")
    for number, request in enumerate(requests):
        _send(service, request, report)
        if number % HEALTHY_EVERY == 0:
            _check_health(service, request, report)
            report.memory.append(memory_of(service))
    report.memory.append(memory_of(service))
    if _victim(service, "GET") != victim:
        report.faults.append("The stored program is not what it was.")
    return report


def _victim(service: Service, method: str) -> str | None:
    """Store the program that changes are for, or look at it: its validator."""
    connection = _connect(service)
    try:
        connection.request(method, VICTIM_PATH, VICTIM if method == "PUT" else None)
        response = connection.getresponse()
        response.read()
        return response.headers["etag"]
    finally:
        connection.close()


def memory_of(service: Service) -> int:
    """What the service and its workers hold in memory, in bytes."""
    processes = [psutil.Process(service.process.pid), *service.workers()]
    return sum(process.memory_info().rss for process in processes)


def _send(service: Service, request: Hostile, report: Report) -> None:
    for _ in range(ATTEMPTS):
        seconds, fault = _try(service, request, report)
        if seconds <= LONGEST_SECONDS or seconds <= cost_of_good_document(service).seconds:
            break
        fault = ", ".join(filter(None, (fault, f"took {seconds:.2f} s")))
    report.seconds[request.kind].append(seconds)
    if fault:
        report.faults.append(f"{request}: {fault}")


def _try(service: Service, request: Hostile, report: Report) -> tuple[float, str | None]:
    connection = _connect(service)
    began = time.perf_counter()
    try:
        # http.client would refuse what it knows to be wrong.
        connection.putrequest(request.method, request.path)
        headers = {"Content-Length": str(len(request.body)), **request.headers}
        for name, value in headers.items():
            connection.putheader(name, value)
        with suppress(ConnectionError):  # refused before it was read; the answer is there
            connection.endheaders(request.body)
        response = connection.getresponse()
        content = response.read()
    except OSError as error:
        return 0.0, repr(error)
    finally:
        connection.close()
    seconds = time.perf_counter() - began
    report.statuses[response.status] += 1
    return seconds, _fault(response.status, response.headers["content-type"], content)


def _fault(status: int, media_type: str | None, content: bytes) -> str | None:
    if not 400 <= status < 500:
        return f"status {status}: {content[:200]!r}"
    if media_type != "application/problem+json":
        return f"came as {media_type}: {content[:200]!r}"
    if len(content) > LARGEST_ANSWER:
        return f"answered {len(content)} bytes"
    return described(json.loads(content))


def _check_health(service: Service, after: Hostile, report: Report) -> None:
    connection = _connect(service)
    try:
        connection.request("POST", "/v1/render", json.dumps(SMALL))
        response = connection.getresponse()
        response.read()
    finally:
        connection.close()
    if response.status != 200:
        report.faults.append(f"after {after}: a good document got {response.status}")


def _connect(service: Service) -> HTTPConnection:
    return HTTPConnection(service.url.removeprefix("http://"), timeout=PATIENCE_SECONDS)
