import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import httpx
import pytest

from app.api.connections import HEAD_BYTES
from tests.api.raw import connect, exchange, host_of, received, status_of
from tests.service import PATIENCE_SECONDS, Service, running_service, until

SECONDS = 1
"""That a head, and a body, may take to come to the impatient service."""

TRIES = 5
"""Whoever behaves is also too late where the machine stops the test for so long; but not often."""


@pytest.fixture(scope="module")
def impatient(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that nobody may keep waiting, not even a test on a busy machine."""
    with running_service(
        tmp_path_factory.mktemp("impatient"),
        warm=False,
        upload_seconds=SECONDS,
        head_seconds=SECONDS,
        max_held_bytes=1_000_000,
    ) as running:
        yield running


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


def answer_to_slow_body(service: Service, beginning: bytes, part: bytes) -> bytes:
    """What is answered to a head that came in time, and a body that does not."""
    for _ in range(TRIES):
        if answer := trickle(service, beginning, part)[1]:
            return answer
    pytest.fail("Nothing was answered.")


def test_a_body_that_comes_too_slowly_is_refused_and_its_connection_closed(
    impatient: Service,
) -> None:
    answer = answer_to_slow_body(impatient, head(impatient, 1000), b" ")
    assert status_of(answer) == 408
    assert b"urn:tubeloom:problem:slow-upload" in answer


def test_a_job_of_a_stored_program_takes_no_body_however_slow_or_long(
    strict: Service, impatient: Service
) -> None:
    def asked(service: Service) -> bytes:
        return head(service, 10**9).replace(b"/v1/layout", b"/v1/jobs?program=stored")

    assert status_of(answer_to_slow_body(impatient, asked(impatient), b"")) == 408
    assert status_of(exchange(strict, asked(strict) + b"x" * 100_000)) == 422


def test_a_head_that_comes_too_slowly_ends_the_connection(impatient: Service) -> None:
    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(trickle, impatient, b"GET /healthz HTTP/1.1\r\n", b"x")
        silent = threads.submit(trickle, impatient, b"", b"")
        for seconds, answer in (first.result(), silent.result()):
            assert answer == b""
            assert seconds > 0.9 * SECONDS


def test_a_connection_is_not_held_by_a_body_that_nobody_reads(impatient: Service) -> None:
    beginning = head(impatient, 10**9).replace(b"/v1/layout", b"/nowhere")
    answer = answer_to_slow_body(impatient, beginning, b" ")
    assert status_of(answer) == 404


def test_a_head_too_large_is_refused(strict: Service) -> None:
    beginning = f"GET /healthz HTTP/1.1\r\nHost: {host_of(strict)}\r\n".encode()
    assert status_of(exchange(strict, beginning + b"A: b\r\n" * 100 + b"\r\n")) == 200
    many = b"".join(b"X-%d: %s\r\n" % (number, b"y" * 100) for number in range(10_000))
    assert len(many) > HEAD_BYTES
    with connect(strict) as connection:
        with suppress(OSError):
            connection.sendall(beginning + many + b"\r\n")
        assert received(connection)[:12] in {b"HTTP/1.1 431", b""}
    assert httpx.get(f"{strict.url}/healthz", timeout=PATIENCE_SECONDS).status_code == 200


def test_a_connection_goes_on_for_who_behaves(impatient: Service) -> None:
    assert any(_goes_on(impatient) for _ in range(TRIES))


def _goes_on(service: Service) -> bool:
    """Whether a connection is good for more requests, also after more than the time for a head."""
    with service.client() as client, suppress(httpx.TransportError):
        found = []
        for pause in (0.0, 1.5 * SECONDS):
            time.sleep(pause)
            found.append(client.get("/healthz").status_code)
            body = (b" " for _ in range(5))
            found.append(client.post("/v1/layout", content=body).status_code)
        return found == [200, 400, 200, 400]
    return False


def test_more_bodies_than_may_be_held_wait_outside(strict: Service) -> None:
    # Where the service has not taken all of the first body yet, it may refuse that one instead.
    until(lambda: _waits_outside(strict))
    with strict.client() as client:
        # What was held has been given back.
        for _ in range(3):
            assert client.post("/v1/layout", content=b" " * 900_000).status_code == 400


def _waits_outside(strict: Service) -> bool:
    """Whether a body that came second was refused, and the first one was served."""
    with connect(strict) as first, strict.client() as client:
        first.sendall(head(strict, 950_000) + b" " * 900_000)
        refused = client.post("/v1/layout", content=b" " * 200_000)
        if refused.status_code != 503:
            return False
        assert refused.json()["type"] == "urn:tubeloom:problem:overloaded"
        assert refused.headers["retry-after"] == "2"
        assert client.post("/v1/layout", content=b" " * 50_000).status_code == 400
        first.sendall(b" " * 50_000)
        assert status_of(received(first)) == 400
    return True


def test_what_was_held_of_a_body_that_came_too_slowly_is_given_back(impatient: Service) -> None:
    beginning = head(impatient, 950_000) + b" " * 900_000
    assert status_of(answer_to_slow_body(impatient, beginning, b"")) == 408
    with impatient.client() as client:
        content = b" " * 900_000
        until(lambda: client.post("/v1/layout", content=content).status_code == 400)
