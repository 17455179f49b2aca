import json
from collections.abc import Iterator
from http.client import HTTPConnection

import httpx
import pytest

from tests.cost import Cost, cost_of, cost_of_good_document
from tests.service import PATIENCE_SECONDS, SMALL, Service

MEGABYTE = 1_000_000


def nested(depth: int) -> bytes:
    return b'{"items": [], "data": {"a": ' + b"[" * depth + b"]" * depth + b"}}"


def in_pieces(size: int) -> Iterator[bytes]:
    for _ in range(size // MEGABYTE):
        yield b" " * MEGABYTE


HOSTILE: dict[str, tuple[bytes | str, int]] = {
    "a body of 100 MB": (b" " * (100 * MEGABYTE), 413),
    "10,000 brackets": (nested(10_000), 400),
    "a coordinate of 1e308": (b'{"items": [{"id": "a", "position": [1e308, 0, 0]}]}', 400),
    "a number that is infinite": (b'{"items": [{"id": "a", "position": [1e999, 0, 0]}]}', 400),
    "not a number": (b'{"items": [{"id": "a", "position": [NaN, 0, 0]}]}', 400),
    "a label of 1 MB": (json.dumps({"items": [{"id": "a", "label": "x" * MEGABYTE}]}), 400),
    "bytes that are no text": (b'{"items": [{"id": "\xff\xfe"}]}', 400),
    "half a pair of surrogates": (rb'{"items": [{"id": "\ud800"}]}', 400),
    "more items than allowed": (
        json.dumps({"items": [{"id": str(number)} for number in range(20_001)]}),
        413,
    ),
    "items 100 deep": (
        json.dumps(
            {
                "items": [
                    {"id": str(depth), **({"parent": str(depth - 1)} if depth else {})}
                    for depth in range(100)
                ]
            }
        ),
        422,
    ),
}


@pytest.fixture(scope="module")
def good(service: Service) -> Cost:
    """Of a document that takes about a second where hostile ones take less than a third of it."""
    service.spent()  # nobody's work goes on any more
    return cost_of_good_document(service)


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_documents_are_refused_at_once(service: Service, good: Cost, name: str) -> None:
    body, status = HOSTILE[name]
    # Not httpx, which takes longer to send 100 MB than the service to refuse them.
    connection = HTTPConnection(service.url.removeprefix("http://"), timeout=PATIENCE_SECONDS)

    def refuse() -> None:
        connection.request("POST", "/v1/render", body)
        response = connection.getresponse()
        content = response.read()
        connection.close()
        assert response.status == status, content[:500]
        assert response.headers["content-type"] == "application/problem+json"
        assert len(content) < 100_000

    # The service may look after itself meanwhile, but not each time.
    assert any(cost_of(service, refuse).cpu < good.cpu for _ in range(3))
    connection.request("POST", "/v1/render", json.dumps(SMALL))
    assert connection.getresponse().status == 200
    connection.close()


def test_a_body_without_a_length_is_refused_as_soon_as_it_is_too_long(
    client: httpx.Client,
) -> None:
    response = client.post("/v1/render", content=in_pieces(100 * MEGABYTE))
    assert response.status_code == 413
    assert response.json()["type"] == "urn:tubeloom:problem:body-too-large"


def test_too_large_a_picture_is_refused(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=png&width=16384&height=16384", json=SMALL)
    assert response.status_code == 400


def test_hostile_documents_cost_no_worker(service: Service, client: httpx.Client) -> None:
    before = {worker.pid for worker in service.workers()}
    for body, _ in HOSTILE.values():
        client.post("/v1/layout", content=body)
    assert {worker.pid for worker in service.workers()} == before
