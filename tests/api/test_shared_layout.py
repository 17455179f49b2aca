"""A posted document is laid out once, whatever is asked of it then."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from app.answers import Answer, LayoutOptions, RenderOptions
from app.output.media import SceneFormat
from app.pipeline import answer
from app.settings import Settings
from tests.service import Service, large_program, running_service

ROUTING = 'tubeloom_stage_seconds_count{stage="laying out hyperedges"}'


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that nobody else asks, with two workers, which do not share what they know."""
    with running_service(tmp_path_factory.mktemp("shared"), workers=2) as running:
        yield running


def routed(client: httpx.Client) -> float:
    """How often hyperedges were routed so far."""
    lines = client.get("/metrics").text.splitlines()
    return sum(float(line.split()[-1]) for line in lines if line.startswith(ROUTING))


def alone(document: bytes, options: RenderOptions | LayoutOptions) -> bytes:
    """What a process of its own answers."""
    made = answer(document, options, Settings())
    assert isinstance(made, Answer)
    return made.body


@pytest.mark.parametrize("first", ["/v1/layout", "/v1/render?format=svg"])
def test_other_answers_take_the_layout_of_the_first(service: Service, first: str) -> None:
    document = large_program(80)
    with service.client() as client:
        before = routed(client)
        client.post(first, content=document).raise_for_status()
        assert routed(client) == before + 1
        scene = client.post("/v1/render?format=glb", content=document)
        numbers = client.post("/v1/layout?patches=true", content=document)
        assert routed(client) == before + 1
    assert scene.content == alone(document, RenderOptions(SceneFormat.GLB))
    assert numbers.content == alone(document, LayoutOptions(patches=True))
