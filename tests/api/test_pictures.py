"""Pictures over HTTP: final quality, drawings, films, sheets and sweeps."""

from __future__ import annotations

import base64
import io
import json
from pathlib import Path
from xml.etree import ElementTree as ET

import httpx
import numpy as np
import pytest
from PIL import Image

from tests.api.event_streams import events
from tests.service import SMALL, fresh

CLAUSE = (Path(__file__).parents[2] / "examples" / "id3-clause-2.json").read_bytes()


def picture(response: httpx.Response) -> Image.Image:
    assert response.status_code == 200, response.text
    return Image.open(io.BytesIO(response.content))


def test_a_final_picture_says_what_it_cost_and_is_the_same_again(client: httpx.Client) -> None:
    query = "/v1/render?format=png&quality=final&width=160&height=120&samples=4&seed=3"
    first, second = (client.post(query, json=SMALL) for _ in range(2))
    assert picture(first).size == (160, 120)
    assert first.headers["tubeloom-samples"] == "4"
    assert first.headers["tubeloom-stopped-by"] == "samples"
    assert float(first.headers["tubeloom-noise"]) > 0
    assert first.content == second.content
    assert first.headers["etag"] == second.headers["etag"]


def test_a_time_limit_gives_the_best_picture_so_far_and_says_so(client: httpx.Client) -> None:
    response = client.post(
        "/v1/render?format=png&quality=final&width=320&height=240&samples=65536&time_limit=1",
        content=CLAUSE,
    )
    assert picture(response).size == (320, 240)
    assert response.headers["tubeloom-stopped-by"] == "time limit"
    assert 4 <= int(response.headers["tubeloom-samples"]) < 65536
    assert "etag" not in response.headers


def test_a_final_picture_can_be_seen_coming(client: httpx.Client) -> None:
    query = "/v1/render?format=png&quality=final&width=160&height=120&samples=32"
    headers = {"accept": "text/event-stream"}
    with client.stream("POST", query, headers=headers, json=SMALL) as response:
        told = list(events(response))
    previews = [event.data for event in told if event.name == "preview"]
    assert len(previews) >= 2
    for preview in previews:
        assert Image.open(io.BytesIO(base64.b64decode(preview["base64"]))).size == (160, 120)
    last = np.asarray(Image.open(io.BytesIO(base64.b64decode(told[-1].data["base64"]))), float)
    errors = [
        float(
            np.abs(
                np.asarray(Image.open(io.BytesIO(base64.b64decode(found["base64"]))), float) - last
            ).mean()
        )
        for found in previews
    ]
    assert errors[-1] < errors[0]


def test_a_drawing_names_every_item_and_hyperedge(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=svg", json=SMALL)
    assert response.headers["content-type"].startswith("image/svg+xml")
    root = ET.fromstring(response.text)
    assert {"x", "y", "z", "e"} <= {node.get("data-id") for node in root.iter()}


@pytest.mark.parametrize("film", ["webp", "mp4"])
def test_a_film_has_its_frames(client: httpx.Client, film: str) -> None:
    response = client.post(
        f"/v1/render?format={film}&width=160&height=120&frames=6&duration=1", json=SMALL
    )
    assert response.status_code == 200
    if film == "webp":
        moving = picture(response)
        assert getattr(moving, "n_frames", 1) == 6
    else:
        assert response.content[4:8] == b"ftyp"


def test_the_frames_of_a_film_are_told_as_they_come(client: httpx.Client) -> None:
    # Nobody waits for all of them.
    query = "/v1/render?format=webp&width=320&height=240&frames=1000"
    document = json.loads(CLAUSE) | {"name": fresh("Filmed")}
    with client.stream(
        "POST", query, headers={"accept": "text/event-stream"}, json=document
    ) as response:
        told = (event.data for event in events(response) if event.name == "progress")
        drawing = (news["share"] for news in told if news["stage"] == "drawing")
        shares = [next(drawing) for _ in range(3)]
        assert 0 < shares[0] < shares[1] < shares[2] < 1


def test_a_film_of_too_many_pixels_is_refused(client: httpx.Client) -> None:
    response = client.post("/v1/render?format=mp4&width=4096&height=4096&frames=1000", json=SMALL)
    assert response.status_code == 422
    assert response.json()["type"].endswith("picture-too-large")


@pytest.mark.parametrize("stereo", ["side-by-side", "anaglyph"])
def test_stereo_has_the_size_that_was_asked_for(client: httpx.Client, stereo: str) -> None:
    document = {**SMALL, "view": {"stereo": stereo}}
    shown = picture(client.post("/v1/render?format=png&width=320&height=120", json=document))
    assert shown.size == (320, 120)
    pixels = np.asarray(shown.convert("RGB"), dtype=float)
    if stereo == "side-by-side":
        left, right = pixels[:, :160], pixels[:, 160:]
        assert np.abs(left - right).max() > 50
    else:
        assert np.abs(pixels[..., 0] - pixels[..., 1]).max() > 50


def test_a_sheet_shows_several_sides(client: httpx.Client) -> None:
    shown = picture(client.post("/v1/render?sheet=true&width=600&height=400", json=SMALL))
    assert shown.size == (600, 400)


def test_a_sweep_shows_variations(client: httpx.Client) -> None:
    query = {"sweep": ["/view/field_of_view=20,60", '/style/background="#ffffff","#202020"']}
    shown = picture(
        client.post("/v1/render", params={**query, "width": 600, "height": 400}, json=SMALL)
    )
    assert shown.size == (600, 400)


@pytest.mark.parametrize(
    ("query", "status"),
    [
        ("sheet=true&format=glb", 422),
        ("sheet=true&sweep=/style/halo=0,1", 422),
        ("sweep=/no/such=1,2", 422),
        ("sweep=/style/halo=-1,2", 422),
        ("sweep=nonsense", 422),
        ("sweep=a&sweep=b&sweep=c", 400),
        ("quality=best", 400),
        ("samples=0", 400),
    ],
)
def test_wishes_that_make_no_sense_are_refused(
    client: httpx.Client, query: str, status: int
) -> None:
    response = client.post(f"/v1/render?{query}", json=SMALL)
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == "application/problem+json"
