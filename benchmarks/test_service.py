"""A posted program's way to its answer, over HTTP, warm."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.service import Service, running_service

EXAMPLES = Path(__file__).parents[1] / "examples"
PROGRAMS = ["id3-clause-1", "id3-clause-2"]


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """A client of a service that has been asked for everything once by each worker."""
    with running_service(tmp_path_factory.mktemp("service"), workers=2) as running:
        service: Service = running
        with service.client() as client:
            yield client


def _measure(benchmark: Any, client: httpx.Client, name: str, form: str, rounds: int) -> None:
    document = (EXAMPLES / f"{name}.json").read_bytes()
    blanks = itertools.count(1)

    def ask() -> httpx.Response:
        return client.post(
            "/v1/render",
            params={"format": form},
            content=document + next(blanks) * b" ",  # else it would be cached
            headers={"Content-Type": "application/json"},
        )

    answer = benchmark.pedantic(ask, rounds=rounds, warmup_rounds=6)
    assert answer.status_code == 200
    benchmark.extra_info["kB"] = len(answer.content) // 1000


@pytest.mark.parametrize("name", PROGRAMS)
def test_glb(benchmark: Any, client: httpx.Client, name: str) -> None:
    """The default answer."""
    benchmark.group = f"{name}.json over HTTP"
    _measure(benchmark, client, name, "glb", 100)


@pytest.mark.parametrize("name", PROGRAMS)
def test_png_of_1024_by_768(benchmark: Any, client: httpx.Client, name: str) -> None:
    """The draft."""
    benchmark.group = f"{name}.json over HTTP"
    _measure(benchmark, client, name, "png", 20)
