from typing import get_args

import httpx
import pytest

from app.formats.registry import FORMATS
from app.notations.loader import notation_names
from app.output.media import SceneFormat
from app.program.model import MaterialName
from app.scene.palette import palette_names
from tests.service import SMALL


def names(entries: list[dict[str, str]]) -> list[str]:
    return [entry["name"] for entry in entries]


def test_every_notation_is_listed(client: httpx.Client) -> None:
    assert names(client.get("/v1/notations").json()) == list(notation_names())


def test_every_material_that_a_document_may_name_is_listed(client: httpx.Client) -> None:
    assert set(names(client.get("/v1/materials").json())) == set(get_args(MaterialName))


def test_every_palette_is_listed_with_its_colours(client: httpx.Client) -> None:
    palettes = client.get("/v1/palettes").json()
    assert names(palettes) == list(palette_names())
    assert all(color.startswith("#") for palette in palettes for color in palette["colors"])


def test_every_format_is_listed(client: httpx.Client) -> None:
    formats = client.get("/v1/formats").json()
    assert names(formats["documents"]) == list(FORMATS)
    assert names(formats["scenes"]) == [scene.value for scene in SceneFormat]


@pytest.mark.parametrize("scene", list(SceneFormat))
def test_every_format_of_scenes_is_answered_as_it_says(
    client: httpx.Client, scene: SceneFormat
) -> None:
    query = "/v1/render?width=160&height=120&frames=3"
    response = client.post(query, json=SMALL, headers={"accept": scene.media_type})
    assert response.status_code == 200
    assert response.headers["content-type"] == scene.media_type
    assert f'.{scene.value}"' in response.headers["content-disposition"]


@pytest.mark.parametrize("name", ["notations", "materials", "palettes", "formats"])
def test_lists_are_not_sent_twice(client: httpx.Client, name: str) -> None:
    first = client.get(f"/v1/{name}")
    again = client.get(f"/v1/{name}", headers={"if-none-match": first.headers["etag"]})
    assert (first.status_code, again.status_code, again.content) == (200, 304, b"")
