"""Answers that are there already, over HTTP."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from tests.api.event_streams import events
from tests.service import PATIENCE_SECONDS, SMALL, Service, fresh, large_program, until


def named(name: str) -> bytes:
    """A small program that nobody has asked for; each call gives another."""
    return json.dumps({**SMALL, "name": fresh(name)}).encode()


@pytest.mark.parametrize("path", ["render", "render?format=png", "layout", "convert?to=hif"])
def test_an_answer_is_there_when_it_is_asked_for_again(
    client: httpx.Client, service: Service, path: str
) -> None:
    document = named(f"again {path}")
    first = client.post(f"/v1/{path}", content=document)
    spent = service.spent()
    second = client.post(f"/v1/{path}", content=document)
    assert (first.status_code, second.status_code) == (200, 200)
    assert first.headers["tubeloom-cache"] == "miss"
    assert second.headers["tubeloom-cache"] == "hit"
    assert second.content == first.content
    same = ("etag", "content-type", "content-disposition", "content-length")
    assert [second.headers[name] for name in same] == [first.headers[name] for name in same]
    tag = {"if-none-match": first.headers["etag"]}
    unchanged = client.post(f"/v1/{path}", content=document, headers=tag)
    assert (unchanged.status_code, unchanged.content) == (304, b"")
    assert unchanged.headers["etag"] == first.headers["etag"]
    assert unchanged.headers["tubeloom-cache"] == "hit"
    assert service.spent() == spent


def test_the_same_question_at_the_same_time_is_worked_on_once(service: Service) -> None:
    document = large_program(202)

    def ask(_number: int) -> httpx.Response:
        with service.client() as client:
            return client.post("/v1/render", content=document)

    with ThreadPoolExecutor(4) as crowd:
        answers = list(crowd.map(ask, range(4)))
    assert {answer.status_code for answer in answers} == {200}
    assert len({answer.content for answer in answers}) == 1
    assert [answer.headers["tubeloom-cache"] for answer in answers].count("miss") == 1


def test_who_leaves_does_not_end_what_another_waits_for(service: Service) -> None:
    document = large_program(303)
    with ThreadPoolExecutor(1) as background, service.client() as other, service.client() as third:
        with service.held():
            stays = background.submit(other.post, "/v1/render", content=document)
            with pytest.raises(httpx.ReadTimeout):
                third.post(
                    "/v1/render",
                    content=document,
                    timeout=httpx.Timeout(PATIENCE_SECONDS, read=0.2),
                )
        assert stays.result().status_code == 200
    with service.client() as client:
        until(lambda: _comes_from_cache(client, document))


def _comes_from_cache(client: httpx.Client, document: bytes) -> bool:
    """Whether it is kept by now: a large answer is written after it was given."""
    return client.post("/v1/render", content=document).headers["tubeloom-cache"] == "hit"


def test_an_answer_that_is_there_comes_as_the_only_event(client: httpx.Client) -> None:
    document = named("as events")
    whole = client.post("/v1/render", content=document)
    accept = {"accept": "text/event-stream, model/gltf-binary"}
    (event,) = events(client.post("/v1/render", content=document, headers=accept))
    assert event.name == "answer"
    assert event.data["headers"]["ETag"] == whole.headers["etag"]
    assert event.data["headers"]["Tubeloom-Cache"] == "hit"
