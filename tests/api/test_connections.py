import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import httpx
import pytest

from app.api.connections import HEAD_BYTES
from tests.api.raw import connect, exchange, host_of, received, status_of
from tests.service import PATIENCE_SECONDS, Service

SECONDS = 1
"""That a head, and a body, may take to come to the strict service."""


def head(service: Service, size: int) -> bytes:
    return (
        f"POST /v1/layout HTTP/1.1\r\nHost: {host_of(service)}\r\nContent-Length: {size}\r\n\r\n"
    ).encode()


def trickle(service: Service, beginning: bytes, part: bytes) -> tuple[float, bytes]:
    """Send a part again and again until the service has had enough, and closes the connection."""
    began = time.monotonic()
    with connect(service) as connection:
        connection.sendall(beginning)
        connection.settimeout(0.2)
        answer = b""
        while time.monotonic() < began + PATIENCE_SECONDS:
            try:
                connection.sendall(part)
                came = connection.recv(65536)
            except TimeoutError:
                continue
            except OSError:
                came = b""
            if not came:
                return time.monotonic() - began, answer
            answer += came
    pytest.fail("The connection was not closed.")


def test_a_body_that_comes_too_slowly_is_refused_and_its_connection_closed(
    strict: Service,
) -> None:
    _, answer = trickle(strict, head(strict, 1000), b" ")
    assert status_of(answer) == 408
    assert b"urn:tubeloom:problem:slow-upload" in answer


def test_a_job_of_a_stored_program_takes_no_body_however_slow_or_long(strict: Service) -> None:
    asked = head(strict, 10**9).replace(b"/v1/layout", b"/v1/jobs?program=stored")
    assert status_of(trickle(strict, asked, b"")[1]) == 408
    assert status_of(exchange(strict, asked + b"x" * 100_000)) == 422


def test_a_head_that_comes_too_slowly_ends_the_connection(strict: Service) -> None:
    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(trickle, strict, b"GET /healthz HTTP/1.1\r\n", b"x")
        silent = threads.submit(trickle, strict, b"", b"")
        for seconds, answer in (first.result(), silent.result()):
            assert answer == b""
            assert seconds > 0.9 * SECONDS


def test_a_connection_is_not_held_by_a_body_that_nobody_reads(strict: Service) -> None:
    beginning = head(strict, 10**9).replace(b"/v1/layout", b"/nowhere")
    _, answer = trickle(strict, beginning, b" ")
    assert status_of(answer) == 404


def test_a_head_too_large_is_refused(strict: Service) -> None:
    beginning = f"GET /healthz HTTP/1.1\r\nHost: {host_of(strict)}\r\n".encode()
    assert status_of(exchange(strict, beginning + b"A: b\r\n" * 100 + b"\r\n")) == 200
    many = b"".join(b"X-%d: %s\r\n" % (number, b"y" * 100) for number in range(10_000))
    assert len(many) > HEAD_BYTES
    with connect(strict) as connection:
        connection.settimeout(5)
        with suppress(OSError):
            connection.sendall(beginning + many + b"\r\n")
        assert received(connection)[:12] in {b"HTTP/1.1 431", b""}
    assert httpx.get(f"{strict.url}/healthz", timeout=PATIENCE_SECONDS).status_code == 200


def test_a_connection_goes_on_for_who_behaves(strict: Service) -> None:
    with strict.client() as client:
        for pause in (0.0, 1.5 * SECONDS):
            time.sleep(pause)
            assert client.get("/healthz").status_code == 200
            body = (b" " for _ in range(5))
            assert client.post("/v1/layout", content=body).status_code == 400


def _refused(client: httpx.Client, body: bytes) -> httpx.Response | None:
    """The answer that there is no room, as soon as the service has taken what others have sent."""
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        answer = client.post("/v1/layout", content=body)
        if answer.status_code == 503:
            return answer
    return None


def test_more_bodies_than_may_be_held_wait_outside(strict: Service) -> None:
    # A body is held for a second, in which a busy machine may get to nothing.
    for _ in range(20):
        with connect(strict) as first, strict.client() as client:
            first.sendall(head(strict, 950_000) + b" " * 900_000)
            refused = _refused(client, b" " * 200_000)
            if refused is None:
                continue
            assert refused.json()["type"] == "urn:tubeloom:problem:overloaded"
            assert refused.headers["retry-after"] == "2"
            assert client.post("/v1/layout", content=b" " * 50_000).status_code == 400
            assert status_of(received(first)) == 408
            # What was held has been given back.
            assert client.post("/v1/layout", content=b" " * 900_000).status_code == 400
            break
    else:
        pytest.fail("Nothing was refused.")
    with strict.client() as client:
        for _ in range(3):
            assert client.post("/v1/layout", content=b" " * 900_000).status_code == 400
