"""What happens while workers are busy, die, or are kept waiting for."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from tests.api.raw import connect, host_of
from tests.service import SMALL, Service, fresh, gone, large_program, running_service, until

LARGE = large_program(600)

VERY_LARGE = large_program(6000)
"""Of which no machine makes a scene in a second."""

FILM = "format=webp&width=640&height=480&frames=1000"
"""A render that takes minutes, none of them for the layout."""


def another(document: bytes, number: int = 1) -> bytes:
    """The same document, but other bytes: what was answered of it before is of no use."""
    return document + number * b" "


def test_a_heavy_render_keeps_nobody_else_waiting(service: Service, client: httpx.Client) -> None:
    spent = service.spent()
    query = "/v1/render?format=png&quality=final&width=64&height=48&samples=65536&time_limit=3"
    with ThreadPoolExecutor(1) as background, service.client() as other:
        heavy = background.submit(other.post, query, json={**SMALL, "name": fresh("Heavy")})
        worker = until(lambda: service.busy_worker(spent))
        worker.suspend()
        try:
            for _ in range(20):
                assert client.get("/healthz").status_code == 200
            assert client.post("/v1/layout", json={**SMALL, "name": fresh("Light")}).is_success
            assert not heavy.done()
        finally:
            worker.resume()
        assert heavy.result().status_code == 200


def test_a_worker_killed_at_work_costs_its_request_a_retry_and_others_nothing(
    service: Service, client: httpx.Client
) -> None:
    whole = client.post("/v1/render", content=LARGE)
    assert whole.status_code == 200
    before = {worker.pid for worker in service.workers()}
    spent = service.spent()
    with ThreadPoolExecutor(1) as background, service.client() as other:
        heavy = background.submit(other.post, "/v1/render", content=another(LARGE))
        victim = until(lambda: service.busy_worker(spent))
        victim.kill()
        assert client.post("/v1/render", json=SMALL).status_code == 200
        assert heavy.result().status_code == 200
        assert heavy.result().content == whole.content
    until(lambda: client.get("/readyz").json()["workers"]["warm"] == 2)
    after = {worker.pid for worker in service.workers()}
    assert after & before == before - {victim.pid}


def test_who_leaves_has_the_long_work_stopped(service: Service, client: httpx.Client) -> None:
    very_large = another(VERY_LARGE, 9)
    spent = service.spent()
    head = f"POST /v1/render HTTP/1.1\r\nHost: {host_of(service)}\r\n"
    with connect(service) as leaving:
        leaving.sendall(f"{head}Content-Length: {len(very_large)}\r\n\r\n".encode() + very_large)
        victim = until(lambda: service.busy_worker(spent))
    until(lambda: gone(victim))
    until(lambda: client.get("/readyz").json()["workers"]["warm"] == 2)


@pytest.fixture(scope="module")
def hurried(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service of one worker that has little time and no line."""
    folder = tmp_path_factory.mktemp("hurried")
    with running_service(folder, workers=1, max_waiting=0, deadline_seconds=1) as service:
        yield service


def test_work_that_takes_too_long_is_stopped(hurried: Service) -> None:
    with hurried.client() as client:
        response = client.post(f"/v1/render?{FILM}", json=SMALL)
        assert response.status_code == 504
        assert response.json()["type"] == "urn:tubeloom:problem:deadline-exceeded"
        until(lambda: client.post("/v1/render", json=SMALL).status_code == 200)


def test_a_full_line_turns_requests_away(hurried: Service) -> None:
    bodies = [another(VERY_LARGE, number) for number in range(6)]
    with hurried.client() as client, ThreadPoolExecutor(6) as crowd:
        until(lambda: client.get("/readyz").json()["workers"]["warm"] == 1)
        answers = list(crowd.map(lambda body: client.post("/v1/render", content=body), bodies))
    turned_away = [answer for answer in answers if answer.status_code == 503]
    assert turned_away
    assert turned_away[0].json()["type"] == "urn:tubeloom:problem:overloaded"
    assert int(turned_away[0].headers["retry-after"]) > 0
