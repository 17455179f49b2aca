from __future__ import annotations

import io
from typing import Any

import httpx
import pytest
import trimesh

from tests.service import SMALL, Service, fresh

FAR = 1e6
TOO_THIN: dict[str, Any] = {
    "items": [
        {"id": name, "position": place}
        for name, place in {"x": [0, 0, 0], "y": [1, 0, 0], "z": [FAR, 0, 0]}.items()
    ],
    "hyperedges": [
        {"id": "thin", "radius": 0.001, "attachments": [{"item": name} for name in "xyz"]}
    ],
}


def read(response: httpx.Response) -> Any:
    assert response.status_code == 200, response.text
    return trimesh.load_mesh(io.BytesIO(response.content), file_type="stl")


@pytest.mark.parametrize("parts", ["all", "items", "hyperedges"])
def test_a_program_comes_back_as_closed_bodies(client: httpx.Client, parts: str) -> None:
    found = read(client.post(f"/v1/render?format=stl&parts={parts}", json=SMALL))
    assert found.is_watertight
    assert found.is_winding_consistent
    assert found.volume > 0


def test_a_hyperedge_is_one_body(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=stl&parts=hyperedges", json=SMALL)
    assert read(response).body_count == 1
    assert response.headers["content-type"] == "model/stl"


def test_the_scale_is_millimetres_to_a_unit(client: httpx.Client) -> None:
    ten, twenty = (
        read(client.post(f"/v1/render?format=stl{scale}", json=SMALL))
        for scale in ("", "&scale=20")
    )
    assert twenty.extents == pytest.approx(2 * ten.extents, rel=1e-5)


@pytest.mark.parametrize(
    ("accept", "media_type"),
    [
        ("model/stl", "model/stl"),
        ("model/3mf", "model/3mf"),
        ("model/stl;q=0.5, model/3mf", "model/3mf"),
        ("model/*", "model/gltf-binary"),
    ],
)
def test_prints_are_negotiated(client: httpx.Client, accept: str, media_type: str) -> None:
    response = client.post("/v1/render", json=SMALL, headers={"accept": accept})
    assert response.headers["content-type"] == media_type


def test_prints_have_validators_of_their_own(client: httpx.Client) -> None:
    queries = ("", "&scale=5", "&parts=items")
    tags = {
        client.post(f"/v1/render?format=stl{query}", json=SMALL).headers["etag"]
        for query in queries
    }
    assert len(tags) == 3


@pytest.mark.parametrize("query", ["scale=0", "scale=-1", "scale=nan", "scale=inf", "parts=none"])
def test_a_print_of_no_size_or_of_nothing_is_refused(client: httpx.Client, query: str) -> None:
    response = client.post(f"/v1/render?format=stl&{query}", json=SMALL)
    assert response.status_code == 400
    assert response.json()["errors"][0]["parameter"] == query.partition("=")[0]


def test_what_cannot_be_printed_is_named(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=stl", json=TOO_THIN)
    problem = response.json()
    assert response.status_code == 422
    assert problem["type"] == "urn:tubeloom:problem:unprintable"
    assert problem["errors"][0]["pointer"] == "/hyperedges/0"
    assert "'thin'" in problem["errors"][0]["detail"]


def test_time_is_told_once_for_all_tubes(client: httpx.Client) -> None:
    document = SMALL | {"name": fresh("Printed")}
    timing = client.post("/v1/render?format=stl", json=document).headers["server-timing"]
    assert timing.count("making-tubes;dur=") == 1


@pytest.mark.parametrize("parts", ["all", "items", "hyperedges"])
def test_too_large_a_print_is_refused(strict: Service, parts: str) -> None:
    with strict.client() as client:
        response = client.post(f"/v1/render?format=3mf&parts={parts}", json=SMALL)
        assert client.post("/v1/render", json=SMALL).status_code == 200
    assert response.status_code == 413
    assert response.json()["type"] == "urn:tubeloom:problem:document-too-large"
    assert "the limit of 500" in response.json()["detail"]
