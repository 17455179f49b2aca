import json
import struct

import httpx
import pytest

from app.api.schema import HYPERGRAPH, NETLIST
from tests.service import SMALL, fresh


def glb_document(body: bytes) -> dict[str, object]:
    magic, version, length, size, _ = struct.unpack("<4sIIII", body[:20])
    assert (magic, version, length) == (b"glTF", 2, len(body))
    document = json.loads(body[20 : 20 + size])
    assert isinstance(document, dict)
    return document


def test_a_program_comes_back_as_glb_by_default(client: httpx.Client) -> None:
    response = client.post("/v1/render", json=SMALL)
    assert response.status_code == 200
    assert response.headers["content-type"] == "model/gltf-binary"
    names = json.dumps(glb_document(response.content)["nodes"])
    assert all(f'"{name}"' in names for name in "xyze")


@pytest.mark.parametrize(
    ("query", "accept", "media_type"),
    [
        ("", "model/gltf+json", "model/gltf+json"),
        ("", "image/*", "image/png"),
        ("format=gltf", "image/png", "model/gltf+json"),
        ("format=png", "*/*", "image/png"),
        ("format=glb", "text/html", "model/gltf-binary"),
    ],
)
def test_format_wins_over_accept(
    client: httpx.Client, query: str, accept: str, media_type: str
) -> None:
    response = client.post(f"/v1/render?{query}", json=SMALL, headers={"accept": accept})
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == media_type
    assert "Accept" in response.headers["vary"]


def test_a_picture_has_the_size_that_was_asked_for(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=png&width=200&height=100", json=SMALL)
    assert response.status_code == 200, response.text
    assert response.content.startswith(b"\x89PNG")
    assert struct.unpack(">II", response.content[16:24]) == (200, 100)


def test_a_file_is_named_after_the_document(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=gltf", json={**SMALL, "name": 'Té/st "1"\n'})
    disposition = response.headers["content-disposition"]
    assert disposition.startswith('inline; filename="Te-st-1.gltf"')


def test_the_same_document_has_the_same_validator_and_bytes(client: httpx.Client) -> None:
    spaced = json.dumps(SMALL, indent=4)
    first = client.post("/v1/render", content=json.dumps(SMALL))
    second = client.post("/v1/render", content=spaced)
    assert first.headers["etag"] == second.headers["etag"]
    assert first.content == second.content


def test_another_question_has_another_validator(client: httpx.Client) -> None:
    tags = {
        client.post(path, json=SMALL).headers["etag"]
        for path in ("/v1/render", "/v1/render?format=gltf", "/v1/render?width=99", "/v1/layout")
    }
    assert len(tags) == 4


@pytest.mark.parametrize("form", ["{}", "W/{}", '"other", {}', "*"])
def test_who_has_the_answer_already_is_told_so(client: httpx.Client, form: str) -> None:
    tag = client.post("/v1/layout", json=SMALL).headers["etag"]
    response = client.post("/v1/layout", json=SMALL, headers={"if-none-match": form.format(tag)})
    assert (response.status_code, response.content) == (304, b"")
    assert response.headers["etag"] == tag


def test_who_has_another_answer_gets_this_one(client: httpx.Client) -> None:
    response = client.post("/v1/layout", json=SMALL, headers={"if-none-match": '"other"'})
    assert response.status_code == 200


@pytest.mark.parametrize(
    "content_type",
    ["application/json", "application/json; charset=utf-8", "application/x-www-form-urlencoded"],
)
def test_documents_come_as_json_or_as_curl_sends_them(
    client: httpx.Client, content_type: str
) -> None:
    response = client.post(
        "/v1/layout", content=json.dumps(SMALL), headers={"content-type": content_type}
    )
    assert response.status_code == 200


def test_a_document_may_come_without_a_media_type(client: httpx.Client) -> None:
    assert client.post("/v1/layout", content=json.dumps(SMALL)).status_code == 200


def test_layout_answers_numbers(client: httpx.Client) -> None:
    numbers = client.post("/v1/layout", json=SMALL).json()
    assert [item["id"] for item in numbers["items"]] == ["x", "y", "z"]
    assert len(numbers["hyperedges"][0]["segments"]) >= 3
    assert not numbers["hyperedges"][0]["segments"][0].get("patches")


def test_layout_answers_patches_when_asked(client: httpx.Client) -> None:
    numbers = client.post("/v1/layout?patches=true", json=SMALL).json()
    assert numbers["hyperedges"][0]["segments"][0]["patches"]


@pytest.mark.parametrize("call", ["layout", "render", "convert"])
def test_a_netlist_is_read_when_asked(client: httpx.Client, call: str) -> None:
    assert client.post(f"/v1/{call}?from=yosys", json=NETLIST).status_code == 200


def test_a_netlist_is_known_by_its_media_type(client: httpx.Client) -> None:
    response = client.post(
        "/v1/convert",
        content=json.dumps(NETLIST),
        headers={"content-type": "application/vnd.yosys+json"},
    )
    assert response.status_code == 200, response.text
    assert client.post("/v1/layout", json=response.json()).status_code == 200


def test_a_hypergraph_becomes_a_program_and_a_program_a_hypergraph(client: httpx.Client) -> None:
    media_type = "application/vnd.hif+json"
    response = client.post(
        "/v1/convert", content=json.dumps(HYPERGRAPH), headers={"content-type": media_type}
    )
    assert response.status_code == 200, response.text
    again = client.post("/v1/convert?to=hif", json=response.json())
    assert again.headers["content-type"] == media_type
    assert again.json()["incidences"] == HYPERGRAPH["incidences"]
    assert client.post("/v1/render?from=hif", json=HYPERGRAPH).status_code == 200


def test_answers_say_where_the_time_went(client: httpx.Client) -> None:
    document = {**SMALL, "name": fresh("Timed")}
    timing = client.post("/v1/render", json=document).headers["server-timing"]
    assert "reading;dur=" in timing
    assert "making-tubes;dur=" in timing
