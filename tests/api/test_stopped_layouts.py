"""Layouts whose time runs out: here all of them, at once, because they have none."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.api.event_streams import events
from tests.api.job_calls import over, start
from tests.service import SMALL, Service, fresh, running_service

HEADER = "tubeloom-stopped-by"
FORMATS = ("glb", "gltf", "png", "svg", "stl", "3mf", "webp")
SIZE = "width=160&height=120&frames=2"


def crossing(routing: str = "planes") -> dict[str, Any]:
    """Hyperedges that pass through each other unless they are kept apart."""
    rows = range(6)
    return {
        "name": fresh("Crossing"),
        "layout": {"routing": routing},
        "items": [
            {"id": f"{side}{row}", "position": [5.0 * side, 1.5 * row, 0.0]}
            for side in range(2)
            for row in rows
        ],
        "hyperedges": [
            {"id": str(row), "attachments": [{"item": f"0{row}"}, {"item": f"1{5 - row}"}]}
            for row in rows
        ],
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("stopped")


@pytest.fixture(scope="module")
def service(folder: Path) -> Iterator[Service]:
    """A service that has no time for layouts."""
    with running_service(folder, layout_share=0) as running:
        yield running


@pytest.fixture
def client(service: Service) -> Iterator[httpx.Client]:
    with service.client() as client:
        yield client


@pytest.mark.parametrize("routing", ["planes", "elastic", "auto"])
def test_numbers_are_those_of_the_best_so_far_with_its_conflicts(
    client: httpx.Client, routing: str
) -> None:
    document = crossing(routing)
    answers = [client.post("/v1/layout", json=document) for _ in range(2)]
    for answer in answers:
        assert answer.status_code == 200
        assert answer.headers[HEADER] == "deadline"
        assert "etag" not in answer.headers
        assert answer.headers["tubeloom-cache"] == "miss"
        found = answer.json()
        assert found["stopped_by"] == "deadline"
        assert len(found["hyperedges"]) == 6
        assert not found["clearance"]["certified"]
        assert found["clearance"]["conflicts"]
        assert "complete" not in found["clearance"]


@pytest.mark.parametrize("format_", FORMATS)
def test_scenes_of_every_format_say_so(client: httpx.Client, format_: str) -> None:
    document = crossing()
    for _ in range(2):
        answer = client.post(f"/v1/render?format={format_}&{SIZE}", json=document)
        assert answer.status_code == 200
        assert answer.headers[HEADER] == "deadline"
        assert "etag" not in answer.headers
        assert answer.headers["tubeloom-cache"] == "miss"


def test_final_pictures_and_sweeps_say_so(client: httpx.Client) -> None:
    for query in ("quality=final&samples=4", "sweep=/style/halo=0,0.3"):
        answer = client.post(f"/v1/render?format=png&{SIZE}&{query}", json=crossing())
        assert answer.status_code == 200
        assert answer.headers[HEADER] == "deadline"
        assert "etag" not in answer.headers


def test_event_streams_say_so(client: httpx.Client) -> None:
    accept = {"accept": "text/event-stream"}
    query = "/v1/render?format=glb"
    with client.stream("POST", query, json=crossing(), headers=accept) as answer:
        *_, last = events(answer)
    assert last.name == "answer"
    headers = {key.lower(): value for key, value in last.data["headers"].items()}
    assert headers[HEADER] == "deadline"
    assert "etag" not in headers
    assert base64.b64decode(last.data["base64"]).startswith(b"glTF")


def test_jobs_say_so_and_others_do_not_get_what_they_made(client: httpx.Client) -> None:
    document = crossing()
    for _ in range(2):
        job = start(client, "format=glb", document)
        assert over(client, job)["state"] == "done"
        result = client.get(f"{job}/result")
        assert result.content.startswith(b"glTF")
        assert result.headers[HEADER] == "deadline"
        assert "etag" not in result.headers


def test_a_stored_layout_stays_as_it_is_until_the_program_is_put_again(folder: Path) -> None:
    document = crossing()
    program = "/v1/programs/crossing"
    with running_service(folder, layout_share=0) as hurried, hurried.client() as client:
        first = client.put(program, json=document)
        assert first.status_code == 201
        assert first.json()["stopped_by"] == "deadline"
        scene = client.get(f"{program}/render?format=glb")
        assert scene.headers[HEADER] == "deadline"
        # It is stored, so that whoever asks again gets the same.
        again = {"if-none-match": scene.headers["etag"]}
        assert client.get(f"{program}/render?format=glb", headers=again).status_code == 304
        patch = {"content-type": "application/merge-patch+json"}
        renamed = client.patch(program, content=json.dumps({"name": "Renamed"}), headers=patch)
        assert renamed.json()["stopped_by"] == "deadline"
        told = client.get(f"{program}/revisions").json()["revisions"]
        assert [each["stopped_by"] for each in told] == ["deadline", "deadline"]
        numbers = client.get(f"{program}/layout")
        assert numbers.headers[HEADER] == "deadline"
        assert numbers.json()["stopped_by"] == "deadline"
        assert numbers.json()["clearance"]["conflicts"]
    with running_service(folder) as patient, patient.client() as client:
        kept = client.get(f"{program}/layout")
        assert kept.json() == numbers.json()
        assert kept.headers[HEADER] == "deadline"
        put = client.put(program, json=document).json()
        assert (put["revision"], put["stopped_by"]) == (3, None)
        whole = client.get(f"{program}/layout")
        assert HEADER not in whole.headers
        assert "stopped_by" not in whole.json()
        assert whole.json()["clearance"]["certified"]


def test_where_there_is_time_nothing_is_said_and_the_answer_is_kept(usual_service: Service) -> None:
    document = crossing()
    with usual_service.client() as client:
        answer = client.post("/v1/layout", json=document)
        assert HEADER not in answer.headers
        assert "stopped_by" not in answer.json()
        assert answer.json()["clearance"]["certified"]
        assert client.post("/v1/layout", json=document).headers["tubeloom-cache"] == "hit"


def test_proofs_are_stopped_as_well(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("unproven")
    with running_service(folder, certificate_share=0) as running, running.client() as client:
        answer = client.post("/v1/layout", json={**SMALL, "name": fresh("Unproven")})
        assert answer.headers[HEADER] == "deadline"
        assert "etag" not in answer.headers
        found = answer.json()
        assert "stopped_by" not in found
        assert found["clearance"]["complete"] is False
        assert found["clearance"]["certified"] is False
        assert client.post("/v1/render", json=SMALL).headers["etag"]
