"""A service whose workers have little memory, asked for what takes more."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.api.job_calls import over, program, start
from tests.service import Service, running_service, until, wide_program

MEMORY = 512 * 1024**2


@pytest.fixture(scope="module")
def poor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """Its workers, and those of its jobs, have as little memory as may be."""
    with running_service(tmp_path_factory.mktemp("poor"), max_worker_bytes=MEMORY) as running:
        yield running


@pytest.fixture
def client(poor: Service) -> Iterator[httpx.Client]:
    """A client of that service."""
    with poor.client() as client:
        yield client


def problem(response: httpx.Response) -> dict[str, Any]:
    """The problem of memory that the response is."""
    found: dict[str, Any] = response.json()
    assert response.status_code == 413, found
    assert found["type"] == "urn:tubeloom:problem:out-of-memory"
    assert "0.5 GiB" in found["detail"]
    return found


def test_pictures_that_cannot_fit_are_refused_before_anything_is_read(
    poor: Service, client: httpx.Client
) -> None:
    before = {worker.pid for worker in poor.workers()}
    for quality in ("draft", "final"):
        for size in ("width=4096&height=4096", "width=8192&height=512"):
            query = f"format=png&quality={quality}&{size}"
            found = problem(client.post(f"/v1/render?{query}", content=b"no document"))
            assert "width=" in found["detail"]
            assert "TUBELOOM_MAX_WORKER_BYTES=" in found["detail"]
    assert {worker.pid for worker in poor.workers()} == before


@pytest.mark.parametrize("quality", ["draft", "final"])
def test_the_size_that_is_said_to_do_does(client: httpx.Client, quality: str) -> None:
    query = f"format=png&quality={quality}&samples=1" if quality == "final" else "format=png"
    refused = client.post(f"/v1/render?{query}&width=2048&height=2048", json=program("large"))
    words = problem(refused)["detail"].replace(" and ", " ").split()
    size = "&".join(word for word in words if word.startswith(("width=", "height=")))
    size = "&".join(size.split("&")[-2:])
    # Twice, since the second is drawn by a worker that has drawn already.
    for name in ("one", "two"):
        drawn = client.post(f"/v1/render?{query}&{size}", json=program(name))
        assert drawn.status_code == 200, drawn.text
        assert drawn.headers["content-type"] == "image/png"


@pytest.mark.parametrize("query", ["format=glb", "format=svg"])
def test_a_document_that_takes_too_much_costs_its_worker_and_nobody_else(
    poor: Service, client: httpx.Client, query: str
) -> None:
    # What a worker did before must not be to blame.
    assert client.post("/v1/layout", json=program("before")).status_code == 200
    (before,) = until(poor.workers)
    problem(client.post(f"/v1/render?{query}", content=wide_program(3000)))
    assert client.post("/v1/render?format=glb", json=program("after")).status_code == 200
    assert before.pid not in {worker.pid for worker in poor.workers()}
    assert not [event for event in poor.events() if event["event"] == "unexpected error"]


def test_a_job_that_takes_too_much_fails_and_the_next_is_done(client: httpx.Client) -> None:
    large = over(client, start(client, "format=glb", wide_program(3000)))
    assert large["state"] == "failed"
    assert large["problem"]["type"] == "urn:tubeloom:problem:out-of-memory"
    wide = start(client, "format=png&quality=final&width=8192&height=512", program("wide"))
    assert "width=" in over(client, wide)["problem"]["detail"]
    small = start(client, "format=glb", json.dumps(program("small")).encode())
    assert over(client, small)["state"] == "done"
