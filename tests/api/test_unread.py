"""Clients that ask for much and do not read it neither fill the memory nor keep it."""

from __future__ import annotations

import asyncio
import json
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from urllib.parse import urlsplit

import psutil
import pytest
from starlette.types import Message, Receive, Scope, Send

from app.api.unread import ABORT, SMALL_BYTES, Unread, UnreadAnswers
from app.errors import Overloaded
from tests.api.raw import host_of, status_of
from tests.service import PATIENCE_SECONDS, Service, running_service, until

MEGABYTE = 1_000_000

ANSWER = 12 * MEGABYTE
"""Much more than the system keeps for a client that does not read."""

MOST_UNREAD = 30 * MEGABYTE

MARGIN = 40 * MEGABYTE
"""What else the service may have taken meanwhile."""

WRITE_SECONDS = 4

CLIENTS = 20

PATH = "/v1/programs/much"


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that has a large program, and keeps few answers for those who do not read."""
    with running_service(
        tmp_path_factory.mktemp("unread"),
        max_unread_bytes=MOST_UNREAD,
        write_seconds=WRITE_SECONDS,
        memory_bytes=0,
    ) as running:
        texts = ["x" * 1000] * (ANSWER // 1000)
        document = json.dumps({"items": [{"id": "a", "data": {"texts": texts}}]})
        with running.client() as client:
            client.put(PATH, content=document).raise_for_status()
            assert len(client.get(PATH).content) > ANSWER
        yield running


def asking(service: Service) -> socket.socket:
    """A connection that has asked for the large program; the system keeps little for it."""
    address = urlsplit(service.url)
    connection = socket.socket()
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 64 * 1024)
    connection.settimeout(PATIENCE_SECONDS)
    connection.connect((address.hostname, address.port))
    head = f"GET {PATH} HTTP/1.1\r\nHost: {host_of(service)}\r\nConnection: close\r\n\r\n"
    connection.sendall(head.encode())
    return connection


def statuses(service: Service) -> list[int]:
    """Of all requests for the large program that have ended."""
    return [event["status"] for event in service.events() if event.get("path") == PATH]


def resident(service: Service) -> int:
    return int(psutil.Process(service.process.pid).memory_info().rss)


def test_answers_that_nobody_reads_are_few_and_go_and_so_does_their_memory(
    service: Service,
) -> None:
    before, ended = resident(service), len(statuses(service))
    with ExitStack() as stack, service.client() as client:
        for _ in range(CLIENTS):
            stack.enter_context(asking(service))
        # All but two are refused; these get their answers as far as the system takes them.
        until(lambda: len(statuses(service)) >= ended + CLIENTS - 2)
        assert statuses(service)[ended:].count(503) >= CLIENTS // 2
        assert resident(service) < before + MOST_UNREAD + MARGIN
        assert client.get("/healthz").status_code == 200
        # All are still connected, as far as they know; the service lets them go.
        until(lambda: len(statuses(service)) == ended + CLIENTS)
        until(lambda: resident(service) < before + MARGIN / 2)
        assert len(client.get(PATH).content) > ANSWER
    told = [event["event"] for event in service.events()]
    assert told.count("connection closed: its client does not read") >= 1
    assert not any(event.get("level") == "error" for event in service.events())


def test_an_answer_that_a_worker_has_made_goes_when_it_was_read(service: Service) -> None:
    items = [{"id": str(number), "label": str(number)} for number in range(1500)]
    with service.client() as client:
        client.post("/v1/layout", json={"items": items[:1]}).raise_for_status()
        before = resident(service)
        answer = client.post("/v1/render?format=gltf", json={"items": items})
        assert len(answer.content) > MARGIN
        until(lambda: resident(service) < before + MARGIN / 2)


def test_who_is_refused_is_told_when_to_come_again(service: Service) -> None:
    with ExitStack() as stack, service.client() as client:

        def refused() -> dict[str, str] | None:
            stack.enter_context(asking(service))
            answer = client.get(PATH)
            if answer.status_code == 200:
                return None
            assert answer.status_code == 503
            assert answer.json()["type"] == "urn:tubeloom:problem:overloaded"
            return dict(answer.headers)

        assert until(refused)["retry-after"] == "2"


def test_who_reads_slowly_but_steadily_gets_all(service: Service) -> None:
    until(lambda: _is_served(service))
    head, _, body = until(lambda: _read_steadily(service)).partition(b"\r\n\r\n")
    assert status_of(head) == 200
    assert json.loads(body)["items"][0]["id"] == "a"


def _read_steadily(service: Service) -> bytes | None:
    """The answer, read for long; none where the machine kept us from reading for a while."""
    received = bytearray()
    longest, began = 0.0, time.monotonic()
    with asking(service) as connection, suppress(ConnectionError):
        last = began
        while part := connection.recv(64 * 1024):
            received += part
            time.sleep(0.05)
            last, before = time.monotonic(), last
            longest = max(longest, last - before)
    if longest > WRITE_SECONDS / 4:
        return None
    assert time.monotonic() - began > 2 * WRITE_SECONDS
    return bytes(received)


def _is_served(service: Service) -> bool:
    with service.client() as client:
        return client.get(PATH).status_code == 200


def test_what_several_clients_get_is_kept_once_and_counts_once() -> None:
    unread = Unread(most=100)
    piece, other = bytes(60), bytes(50)
    with unread.holding((piece,)), unread.holding((piece,)):
        assert unread.waiting == 60
        with pytest.raises(Overloaded), unread.holding((other,)):
            pass
        unread.check(40)
    assert unread.waiting == 0
    with (
        unread.holding((bytes(1000),)),
        pytest.raises(Overloaded),
    ):  # alone it is sent, however large
        unread.check()
    unread.check(1000)


def test_large_pieces_count_until_they_are_read_and_one_too_many_ends_its_connection() -> None:
    unread = Unread(most=3 * SMALL_BYTES)
    aborted: list[str] = []

    async def two_pieces(_scope: Scope, _receive: Receive, send: Send) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": bytes(2 * SMALL_BYTES)})

    async def serve() -> None:
        app = UnreadAnswers(two_pieces, unread)
        may_read = asyncio.Event()
        sent: list[Message] = []

        async def send(message: Message) -> None:
            # As a server does that has written one large piece: it waits before the next.
            if sent and len(sent[-1].get("body", b"")) > SMALL_BYTES:
                await may_read.wait()
            sent.append(message)

        async def receive() -> Message:
            return {"type": "http.disconnect"}

        def request(name: str) -> Scope:
            return {"type": "http", "state": {ABORT: lambda: aborted.append(name)}}

        first = asyncio.create_task(app(request("first"), receive, send))
        await asyncio.sleep(0)
        assert unread.waiting == 2 * SMALL_BYTES
        quick: list[Message] = []

        async def take(message: Message) -> None:
            quick.append(message)

        await app(request("second"), receive, take)
        assert aborted == ["second"]
        assert [message["type"] for message in quick] == ["http.response.start"]
        may_read.set()
        await first
        assert [message.get("more_body", True) for message in sent] == [True, True, False]
        assert unread.waiting == 0

    asyncio.run(serve())
