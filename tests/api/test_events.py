from __future__ import annotations

import base64

import httpx

from tests.api.event_streams import Event, events
from tests.service import SMALL, Service, fresh, large_program, spent_until_gone, until

STREAM = {"accept": "text/event-stream"}


def stream(client: httpx.Client, query: str, content: bytes | None = None) -> list[Event]:
    body = {"json": SMALL} if content is None else {"content": content}
    with client.stream("POST", f"/v1/render?{query}", headers=STREAM, **body) as response:
        assert response.status_code == 200
        assert response.headers["content-type"].startswith("text/event-stream")
        return list(events(response))


def test_the_last_event_is_what_a_plain_request_gets(client: httpx.Client) -> None:
    plain = client.post("/v1/render?format=gltf", json=SMALL)
    last = stream(client, "format=gltf")[-1]
    assert last.name == "answer"
    assert base64.b64decode(last.data["base64"]) == plain.content
    assert last.data["media_type"] == plain.headers["content-type"]
    assert last.data["headers"]["ETag"] == plain.headers["etag"]


def test_progress_rises_from_nothing_to_the_end(client: httpx.Client) -> None:
    told = stream(client, "format=glb", large_program(200))
    # How much is told on the way depends on how long that takes; the beginning always is.
    shares = [event.data["share"] for event in told if event.name == "progress"]
    assert shares == sorted(shares)
    assert shares[0] < 0.2
    assert shares[-1] <= 1
    assert [event.name for event in told[len(shares) :]] == ["answer"]


def test_a_problem_ends_the_stream_as_it_would_end_a_request(client: httpx.Client) -> None:
    last = stream(client, "", b'{"items": 1}')[-1]
    assert last.name == "problem"
    assert last.data["type"] == "urn:tubeloom:problem:invalid-document"
    assert last.data["errors"][0]["pointer"] == "/items"


def test_what_is_accepted_besides_says_in_which_format_the_answer_comes(
    client: httpx.Client,
) -> None:
    headers = {"accept": "text/event-stream, model/gltf+json"}
    with client.stream("POST", "/v1/render", headers=headers, json=SMALL) as response:
        last = list(events(response))[-1]
    assert last.data["media_type"] == "model/gltf+json"


def test_who_leaves_a_final_picture_frees_the_processor_within_a_second(service: Service) -> None:
    with service.client() as client:
        until(lambda: client.get("/readyz").json()["workers"]["warm"] == 2)
        spent = service.spent()
        query = "/v1/render?format=png&quality=final&samples=65536"
        document = SMALL | {"name": fresh("Left")}
        with client.stream("POST", query, headers=STREAM, json=document) as response:
            told = events(response)  # unnamed it would be closed, and the stream with it
            shares: list[float] = []
            while len(set(shares)) < 3:
                event = next(told)
                assert event.name in {"progress", "preview"}
                if event.name == "progress":
                    shares.append(event.data["share"])
            assert shares == sorted(shares)
            busy = until(lambda: service.busy_worker(spent))
    assert spent_until_gone(busy) < 1.0
