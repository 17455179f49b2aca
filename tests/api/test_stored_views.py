"""Stored programs to look at: scenes that keep still, what changed, older revisions."""

from __future__ import annotations

import uuid
from typing import Any

import httpx
import pytest

from benchmarks.random_programs import random_program
from tests.output.gltf_reader import Asset
from tests.service import SMALL


@pytest.fixture
def path(client: httpx.Client) -> str:
    """Where the small program is."""
    path = f"/v1/programs/{uuid.uuid4().hex}"
    client.put(path, json=SMALL)
    return path


def edit(client: httpx.Client, path: str, *edits: dict[str, Any]) -> int:
    return int(client.post(f"{path}/edits", json={"edits": edits}).json()["revision"])


ADD = {"type": "add_item", "item": {"id": "w", "label": "W"}}
JOIN = {
    "type": "add_hyperedge",
    "hyperedge": {"id": "f", "attachments": [{"item": "x"}, {"item": "w"}]},
}


def nodes(data: bytes) -> dict[str, dict[str, Any]]:
    """What can be seen of a scene: nodes with a mesh in or under them, by name."""
    document = Asset.from_glb(data).json
    found = document["nodes"]

    def shows(node: dict[str, Any]) -> bool:
        return "mesh" in node or any(shows(found[child]) for child in node.get("children", ()))

    return {node["name"]: node for node in found[1:] if shows(node)}


def delta(data: bytes) -> Any:
    scene = Asset.from_glb(data).json["scenes"][0]
    return scene.get("extras", {}).get("delta")


def test_a_scene_of_what_changed_alone(client: httpx.Client, path: str) -> None:
    before = client.get(f"{path}/render")
    assert before.headers["tubeloom-revision"] == "1"
    assert edit(client, path, ADD, JOIN) == 2
    since = client.get(f"{path}/render", params={"since": 1})
    assert (since.status_code, since.headers["tubeloom-since"]) == (200, "1")
    whole = nodes(client.get(f"{path}/render").content)
    changed = nodes(since.content)
    assert set(changed) < set(whole)
    assert {"w", "f"} <= {name.split()[-1] for name in changed} | set(changed)
    assert not {"x", "y", "z"} & set(changed)
    assert delta(since.content) == {
        "since": 1,
        "revision": 2,
        "removed": {"items": [], "hyperedges": []},
    }
    assert delta(before.content) is None


def materials(data: bytes) -> set[str]:
    """The names of what is drawn in a scene."""
    return {material["name"] for material in Asset.from_glb(data).json["materials"]}


def test_colours_that_an_edit_left_alone_are_told_as_they_are_drawn(
    client: httpx.Client, path: str
) -> None:
    edit(client, path, ADD, JOIN)
    (_, before) = client.get(f"{path}/layout").json()["hyperedges"]
    edit(client, path, {"type": "remove_hyperedge", "id": "e"})
    (after,) = client.get(f"{path}/layout").json()["hyperedges"]
    assert (after["id"], after["color"]) == ("f", before["color"])
    assert f"plastic {after['color']}" in materials(client.get(f"{path}/render").content)
    anew = client.post("/v1/layout", content=client.get(path).content)
    assert anew.json()["hyperedges"][0]["color"] != after["color"], "it would be the first"


def test_what_was_removed_is_named(client: httpx.Client, path: str) -> None:
    edit(client, path, ADD, JOIN)
    edit(client, path, {"type": "remove_item", "id": "w"})
    since = client.get(f"{path}/render", params={"since": 2})
    assert delta(since.content)["removed"] == {"items": ["w"], "hyperedges": ["f"]}
    nothing = client.get(f"{path}/render", params={"since": 3})
    assert nodes(nothing.content) == {}
    # what came and went meanwhile is not spoken of
    assert delta(client.get(f"{path}/render", params={"since": 1}).content)["removed"] == {
        "items": [],
        "hyperedges": [],
    }


def test_where_all_is_new_the_whole_scene_comes(client: httpx.Client, path: str) -> None:
    edit(client, path, {"type": "set_program", "fields": {"style": {"palette": "okabe-ito"}}})
    since = client.get(f"{path}/render", params={"since": 1})
    if since.status_code == 422:  # there is no such palette
        pytest.fail(since.text)
    assert "tubeloom-since" not in since.headers
    assert {"x", "y", "z", "e"} <= set(nodes(since.content))


def test_since_what_is_yet_to_come(client: httpx.Client, path: str) -> None:
    early = client.get(f"{path}/render", params={"since": 9})
    assert (early.status_code, early.json()["type"]) == (422, "urn:tubeloom:problem:contradiction")
    picture = client.get(f"{path}/render", params={"since": 1, "format": "png"})
    assert picture.status_code == 422


def test_an_older_revision_looks_as_it_did(client: httpx.Client, path: str) -> None:
    before = {view: client.get(path + view) for view in ("", "/render", "/layout")}
    edit(client, path, ADD, JOIN)
    for view, answer in before.items():
        old = client.get(path + view, params={"revision": 1})
        assert old.content == answer.content
        assert old.headers["etag"] == answer.headers["etag"]
        assert client.get(path + view).headers["etag"] != answer.headers["etag"]
        assert client.get(path + view, params={"revision": 7}).status_code == 404


def test_an_edit_moves_nothing_that_it_does_not_concern(client: httpx.Client, path: str) -> None:
    def places() -> dict[str, Any]:
        numbers = client.get(f"{path}/layout").json()
        return {item["id"]: item for item in numbers["items"]}

    before = places()
    edit(client, path, ADD, JOIN)
    after = places()
    assert {name: after[name] for name in before} == before
    posted = client.post("/v1/layout", json=client.get(path).json()).json()
    assert {item["id"] for item in posted["items"]} == set(after)


@pytest.mark.parametrize("routing", ["elastic", "auto"])
def test_an_edit_leaves_curves_by_relaxation_as_they_are(
    client: httpx.Client, path: str, routing: str
) -> None:
    def curves() -> dict[str, Any]:
        numbers = client.get(f"{path}/layout").json()
        return {hyperedge["id"]: hyperedge["segments"] for hyperedge in numbers["hyperedges"]}

    client.put(path, json=random_program(5, 0).document(routing=routing))
    before = curves()
    edit(client, path, {"type": "remove_hyperedge", "id": "e2"})
    new = {"id": "new", "attachments": [{"item": "i0"}, {"item": "i3"}]}
    edit(client, path, {"type": "add_hyperedge", "hyperedge": new})
    del before["e2"]
    assert before.items() <= curves().items()
    part = client.get(f"{path}/render", params={"since": 3})
    assert part.headers["tubeloom-since"] == "3"
    assert nodes(part.content).keys() == {"new"}


def test_who_has_a_view_is_told_so(client: httpx.Client, path: str) -> None:
    for view in ("/render", "/layout", "/convert"):
        first = client.get(path + view)
        again = client.get(path + view, headers={"If-None-Match": first.headers["etag"]})
        assert again.status_code == 304


def test_every_format_can_be_had(client: httpx.Client, path: str) -> None:
    for name in ("glb", "gltf", "png", "svg", "stl", "3mf"):
        view = client.get(f"{path}/render", params={"format": name, "width": 320, "height": 240})
        assert view.status_code == 200, view.text
    typo = client.get(f"{path}/render", params={"fromat": "png"})
    assert typo.status_code == 400
