import json
from collections.abc import Iterator

import httpx
import pytest
from starlette.requests import Request

from app import errors
from app.api.problems import KINDS, problem_response
from tests.service import SMALL


def leaves(cls: type[Exception]) -> Iterator[type[Exception]]:
    children = cls.__subclasses__()
    if not children:
        yield cls
    for child in children:
        yield from leaves(child)


@pytest.mark.parametrize("error", list(leaves(errors.TubeloomError)))
def test_every_error_of_ours_is_a_kind_of_problem(error: type[Exception]) -> None:
    assert error in KINDS


def test_kinds_have_names_of_their_own() -> None:
    assert len({kind.type for kind in KINDS.values()}) == len(KINDS)


def test_an_unexpected_error_shows_nothing_of_our_insides() -> None:
    response = problem_response(Request({"type": "http"}), KeyError("secret"))
    assert response.status_code == 500
    assert b"secret" not in bytes(response.body)
    assert b"KeyError" not in bytes(response.body)


def test_who_is_turned_away_is_told_when_to_come_again() -> None:
    response = problem_response(Request({"type": "http"}), errors.Overloaded("Busy."))
    assert response.status_code == 503
    assert int(response.headers["retry-after"]) > 0


@pytest.mark.parametrize(
    ("document", "status", "name", "pointer"),
    [
        ("nonsense", 400, "unreadable-document", ""),
        ("", 400, "unreadable-document", ""),
        ('{"items": 3}', 400, "invalid-document", "/items"),
        ('{"items": [], "itmes": []}', 400, "invalid-document", "/itmes"),
        ('{"items": [{"id": "a"}, {"id": "a"}]}', 422, "inconsistent-document", "/items/1/id"),
        (
            '{"items": [{"id": "a", "parent": "b"}]}',
            422,
            "inconsistent-document",
            "/items/0/parent",
        ),
    ],
)
def test_a_bad_document_is_refused_with_the_place(
    client: httpx.Client, document: str, status: int, name: str, pointer: str
) -> None:
    response = client.post("/v1/render", content=document)
    problem = response.json()
    assert response.headers["content-type"] == "application/problem+json"
    assert (response.status_code, problem["status"]) == (status, status)
    assert problem["type"] == f"urn:tubeloom:problem:{name}"
    assert pointer in [fault["pointer"] for fault in problem["errors"]]
    assert all(fault["detail"] for fault in problem["errors"])


def test_all_faults_come_at_once(client: httpx.Client) -> None:
    document = {"items": [{"id": ""}, {"id": "b", "color": "red"}], "extra": 1}
    problem = client.post("/v1/render", json=document).json()
    assert {fault["pointer"] for fault in problem["errors"]} == {
        "/items/0/id",
        "/items/1/color",
        "/extra",
    }


@pytest.mark.parametrize(
    ("query", "parameter"),
    [
        ("widht=100", "widht"),
        ("width=0", "width"),
        ("width=big", "width"),
        ("width=16384&height=16384", "height"),
        ("format=gif", "format"),
        ("quality=best", "quality"),
        ("from=verilog", "from"),
    ],
)
def test_a_wrong_parameter_is_named(client: httpx.Client, query: str, parameter: str) -> None:
    response = client.post(f"/v1/render?{query}", json=SMALL)
    assert response.status_code == 400
    assert response.json()["type"] == "urn:tubeloom:problem:invalid-parameter"
    assert parameter in [fault["parameter"] for fault in response.json()["errors"]]


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [("GET", "/v1/nothing", 404), ("GET", "/v1/render", 405), ("DELETE", "/healthz", 405)],
)
def test_wrong_paths_and_methods_are_problems_too(
    client: httpx.Client, method: str, path: str, status: int
) -> None:
    response = client.request(method, path)
    assert response.status_code == response.json()["status"] == status
    assert response.headers["content-type"] == "application/problem+json"
    assert ("allow" in response.headers) == (status == 405)


@pytest.mark.parametrize(
    "headers",
    [{"content-type": "text/xml"}, {"content-type": "nonsense"}, {"content-encoding": "gzip"}],
)
def test_a_body_that_is_not_plain_json_is_refused(
    client: httpx.Client, headers: dict[str, str]
) -> None:
    response = client.post("/v1/render", content=json.dumps(SMALL), headers=headers)
    assert response.status_code == 415
    assert response.json()["type"] == "urn:tubeloom:problem:unsupported-media-type"


def test_what_cannot_be_accepted_is_refused(client: httpx.Client) -> None:
    for call in ("render", "layout", "convert"):
        response = client.post(f"/v1/{call}", json=SMALL, headers={"accept": "text/html"})
        assert response.status_code == 406
        assert response.headers["content-type"] == "application/problem+json"


def test_too_many_pixels_together_are_refused(client: httpx.Client) -> None:
    response = client.post("/v1/render?width=8192&height=8192&format=png", json=SMALL)
    assert response.status_code == 422
    assert response.json()["type"] == "urn:tubeloom:problem:picture-too-large"
