from __future__ import annotations

import io
from concurrent.futures import ThreadPoolExecutor
from xml.etree import ElementTree as ET

import httpx
import numpy as np
import pytest
from PIL import Image

from tests.service import SMALL, Service


@pytest.mark.parametrize(
    ("query", "body", "status"),
    [
        ("", b'{"items": 1}', 400),
        ("width=0", b"{}", 400),
        ("width=999999999999999999999", b"{}", 400),
        ("", b'{"items": [{"id": "a", "parent": "b"}]}', 422),
    ],
)
def test_a_problem_comes_as_a_picture_with_its_own_status(
    client: httpx.Client, query: str, body: bytes, status: int
) -> None:
    response = client.post(f"/v1/render?errors=image&format=png&{query}", content=body)
    assert response.status_code == status
    assert response.headers["content-type"] == "image/png"
    pixels = np.asarray(Image.open(io.BytesIO(response.content)).convert("L"))
    assert np.ptp(pixels) > 100


def test_the_picture_has_the_size_that_was_asked_for(client: httpx.Client) -> None:
    response = client.post("/v1/render?errors=image&format=png&width=640&height=480", content=b"{}")
    assert Image.open(io.BytesIO(response.content)).size == (640, 480)


def test_a_large_picture_comes_smaller_in_the_same_shape(client: httpx.Client) -> None:
    query = "errors=image&format=png&width=4096&height=2048"
    response = client.post(f"/v1/render?{query}", content=b"{}")
    assert Image.open(io.BytesIO(response.content)).size == (1024, 512)


@pytest.mark.parametrize("call", ["GET /nowhere", "DELETE /v1/render"])
def test_who_asks_for_what_there_is_not_gets_no_picture(client: httpx.Client, call: str) -> None:
    method, path = call.split(" ")
    response = client.request(method, f"{path}?errors=image&width=2048&height=2048")
    assert response.status_code in {404, 405}
    assert response.headers["content-type"] == "application/problem+json"


def test_who_has_no_key_gets_no_picture(guarded: Service) -> None:
    response = httpx.post(f"{guarded.url}/v1/render?errors=image&format=png", content=b"{}")
    assert response.status_code == 401
    assert response.headers["content-type"] == "application/problem+json"


def test_many_who_ask_for_pictures_get_these_or_json(client: httpx.Client) -> None:
    def ask(number: int) -> httpx.Response:
        # Each asks for another picture: those that are drawn are kept.
        query = f"errors=image&format=png&width={800 + number}"
        return client.post(f"/v1/programs/nobody/undo?{query}")

    with ThreadPoolExecutor(40) as threads:
        answers = list(threads.map(ask, range(40)))
    kinds = {answer.headers["content-type"] for answer in answers}
    assert {answer.status_code for answer in answers} == {404}
    assert "image/png" in kinds <= {"image/png", "application/problem+json"}


def test_drawings_have_drawn_problems_that_can_be_read(client: httpx.Client) -> None:
    response = client.post("/v1/render?errors=image&format=svg", content=b'{"items": 1}')
    assert response.headers["content-type"].startswith("image/svg+xml")
    text = "".join(ET.fromstring(response.text).itertext())
    assert "/items" in text


def test_what_is_right_is_answered_as_ever(client: httpx.Client) -> None:
    response = client.post("/v1/render?errors=image", json=SMALL)
    assert response.content.startswith(b"glTF")
