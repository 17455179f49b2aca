"""Heads as large as they may be cost the event loop little, whatever is in them.

What is measured is the CPU time of the thread that runs the event loop, beside that of plain
requests with heads as large: no machine is too slow for that.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from http.client import HTTPConnection

import psutil
import pytest

from tests.api.raw import host_of
from tests.service import PATIENCE_SECONDS, SMALL, Service, fresh

SIZE = 60_000
"""Bytes of one header or query; a head may have 65,536."""

PLAIN_REQUESTS = 100
"""Together they are what one may cost. None costs more than a tenth of that here; what grows with
the square of the size costs ten times as much."""

TRIES = 3
"""What costs too much each time does: the service looks after itself meanwhile."""

FILLINGS = (
    *(" ", "\t", ",", '"', ";", "\\", "=", "%", "a", "1", "-", ":", "/", "[", "."),
    *('"\\', ", ", "; ", '="', "a ", "a,", "a=", '"a",', 'W/"', "%2", "%41", "*/*,", "a/b;q=1,"),
    *("a/a,", ";q=", "a=;", '"a" ', "0-1,", "::"),
)

HEADERS = {
    "Prefer": "POST /v1/render",
    "Accept": "POST /v1/render",
    "Authorization": "POST /v1/layout",
    "Content-Type": "POST /v1/render",
    "Content-Encoding": "POST /v1/render",
    "If-None-Match": "POST /v1/layout",
    "If-Match": "PUT /v1/programs/hostile",
    "Idempotency-Key": "PUT /v1/programs/hostile",
    "Last-Event-ID": "GET /v1/programs/nobody/events",
    "Origin": "POST /v1/layout",
    "Host": "POST /v1/layout",
    "Range": "GET /docs/assets/swagger-ui.css",
    "If-Range": "GET /docs/assets/swagger-ui.css",
    "If-Modified-Since": "GET /docs/assets/swagger-ui.css",
    "Cookie": "GET /docs",
    "X-Request-ID": "GET /healthz",
    "X-Forwarded-For": "GET /healthz",
    "Forwarded": "GET /healthz",
    "traceparent": "POST /v1/layout",
    "tracestate": "POST /v1/layout",
    "Connection": "GET /healthz",
    "Expect": "GET /healthz",
    "Access-Control-Request-Headers": "OPTIONS /v1/render",
}
"""Each header that something reads, and a call that reads it."""

BEGINNINGS = {
    "Prefer": ("", "respond-async, wait=1, "),
    "Range": ("", "bytes=0-1,"),
    "Authorization": ("", "Bearer "),
    "traceparent": ("", "00-"),
}

QUERIES = {
    "names": "&".join(f"n{number}=" for number in range(8_000)),
    "a name again": "width=1&" * (SIZE // 8),
    "a list": "sweep=/a&" * (SIZE // 9),
    "sweeps": "&".join(f"sweep=/{name}=" + "," * (SIZE // 2 - 10) for name in "ab"),
    "ampersands": "&" * SIZE,
    "equals signs": "=" * SIZE,
    "per cent signs": "%" * SIZE,
    "escapes": "format=" + "%41" * (SIZE // 3),
    "escaped names": "%41=1&" * (SIZE // 6),
    "a long name": "a" * SIZE + "=1",
    "a long value": "format=" + "a" * SIZE,
    "a whole number": "width=" + "1" * SIZE,
    "a number": "noise=0." + "1" * SIZE,
    "an exponent": "scale=1e" + "9" * SIZE,
    "pluses": "+" * SIZE,
    "semicolons": ";" * SIZE,
}

CALLS = ("POST /v1/render", "POST /v1/layout", "POST /v1/jobs", "GET /v1/programs", "GET /nowhere")


def spent(service: Service) -> float:
    """CPU seconds of the service's event loop, which runs in its first thread."""
    process = psutil.Process(service.process.pid)
    (loop,) = (thread for thread in process.threads() if thread.id == process.pid)
    return float(loop.user_time + loop.system_time)


def ask(service: Service, call: str, lines: list[tuple[str, str]]) -> tuple[int, bytes]:
    """Status and body of the answer to a call with these headers."""
    method, _, url = call.partition(" ")
    body = b"" if method == "GET" else json.dumps(SMALL | {"name": fresh("Head")}).encode()
    connection = HTTPConnection(host_of(service), timeout=PATIENCE_SECONDS)
    has_host = any(name == "Host" for name, _ in lines)
    connection.putrequest(method, url, skip_host=has_host, skip_accept_encoding=True)
    for name, value in [*lines, ("Content-Length", str(len(body)))]:
        connection.putheader(name, value)
    connection.endheaders(body)
    response = connection.getresponse()
    answer = response.read()
    connection.close()
    assert response.status < 500, answer[:500]
    return response.status, answer


@pytest.fixture(scope="module")
def most(service: Service) -> float:
    """CPU seconds of the event loop for `PLAIN_REQUESTS` with as large a head."""
    before = spent(service)
    for _ in range(PLAIN_REQUESTS):
        ask(service, "POST /v1/layout", [("X-Nothing", "a" * SIZE)])
    return spent(service) - before


def costs_little(
    service: Service, most: float, request: Callable[[], tuple[int, bytes]], large: int
) -> bool:
    """Whether it costs less than ``most``; what is refused must be so in fewer bytes than that."""
    for _ in range(TRIES):
        before = spent(service)
        status, answer = request()
        assert status < 400 or len(answer) < large
        if spent(service) - before < most:
            return True
    return False


@pytest.mark.parametrize("name", HEADERS)
def test_no_header_holds_the_event_loop(service: Service, most: float, name: str) -> None:
    for filling in FILLINGS:
        for beginning in BEGINNINGS.get(name, ("",)):
            value = beginning + (filling * SIZE)[: SIZE - len(beginning)]
            request = partial(ask, service, HEADERS[name], [(name, value)])
            assert costs_little(service, most, request, 2_000), (filling, beginning)


@pytest.mark.parametrize("name", QUERIES)
def test_no_query_holds_the_event_loop(service: Service, most: float, name: str) -> None:
    for call in CALLS:
        request = partial(ask, service, f"{call}?{QUERIES[name]}", [])
        assert costs_little(service, most, request, 20_000), call


@pytest.mark.parametrize("name", ["a", "Accept", "Prefer", "If-None-Match", "Cookie"])
def test_many_headers_do_not_hold_the_event_loop(service: Service, most: float, name: str) -> None:
    lines = [(name, "a")] * (SIZE // (len(name) + 5))
    assert costs_little(service, most, partial(ask, service, "POST /v1/render", lines), 20_000)


def test_a_query_of_many_parameters_is_refused_by_their_number(service: Service) -> None:
    status, answer = ask(service, f"POST /v1/render?{QUERIES['names']}", [])
    assert status == 400
    assert b"urn:tubeloom:problem:long-query" in answer
    assert b"8000 parameters" in answer
