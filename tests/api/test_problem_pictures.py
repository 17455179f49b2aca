from __future__ import annotations

import io
from xml.etree import ElementTree as ET

import httpx
import numpy as np
import pytest
from PIL import Image

from tests.service import SMALL


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


def test_drawings_have_drawn_problems_that_can_be_read(client: httpx.Client) -> None:
    response = client.post("/v1/render?errors=image&format=svg", content=b'{"items": 1}')
    assert response.headers["content-type"].startswith("image/svg+xml")
    text = "".join(ET.fromstring(response.text).itertext())
    assert "/items" in text


def test_what_is_right_is_answered_as_ever(client: httpx.Client) -> None:
    response = client.post("/v1/render?errors=image", json=SMALL)
    assert response.content.startswith(b"glTF")
