"""Stored programs over HTTP: put, got, changed, taken back, deleted."""

from __future__ import annotations

import json
import uuid
from typing import Any

import httpx
import pytest

from tests.service import SMALL


@pytest.fixture
def path() -> str:
    """Where no program is yet."""
    return f"/v1/programs/{uuid.uuid4().hex}"


def edit(client: httpx.Client, path: str, *edits: dict[str, Any], **headers: str) -> httpx.Response:
    return client.post(f"{path}/edits", json={"edits": edits}, headers=headers)


ADD = {"type": "add_item", "item": {"id": "w", "label": "W"}}
CONNECT = {"type": "connect", "id": "e", "attachments": [{"item": "w"}]}


def test_what_is_put_is_got(client: httpx.Client, path: str) -> None:
    put = client.put(path, json=SMALL)
    assert put.status_code == 201
    assert put.headers["location"] == path
    assert put.json()["changes"]["items"]["added"] == ["x", "y", "z"]
    got = client.get(path)
    assert got.headers["etag"] == put.headers["etag"]
    assert [item["id"] for item in got.json()["items"]] == ["x", "y", "z"]
    assert client.get(path, headers={"If-None-Match": got.headers["etag"]}).status_code == 304
    again = client.put(path, content=got.content, headers={"Content-Type": "application/json"})
    assert (again.status_code, again.headers["etag"]) == (200, got.headers["etag"])


def test_other_formats_are_stored_as_programs(client: httpx.Client, path: str) -> None:
    hif = {"incidences": [{"edge": "e", "node": "a"}, {"edge": "e", "node": "b"}]}
    assert client.put(path, params={"from": "hif"}, json=hif).status_code == 201
    assert [item["id"] for item in client.get(path).json()["items"]] == ["a", "b"]
    back = client.get(f"{path}/convert", params={"to": "hif"})
    assert {(one["edge"], one["node"]) for one in back.json()["incidences"]} == {
        ("e", "a"),
        ("e", "b"),
    }


def test_edits_are_done_together(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    done = edit(client, path, ADD, CONNECT)
    assert (done.status_code, done.json()["revision"]) == (200, 2)
    assert done.json()["changes"] == {
        "items": {"added": ["w"], "changed": [], "removed": []},
        "hyperedges": {"added": [], "changed": ["e"], "removed": []},
        "whole": False,
    }
    assert len(client.get(path).json()["hyperedges"][0]["attachments"]) == 4


def test_an_edit_that_does_not_fit_leaves_everything_as_it_was(
    client: httpx.Client, path: str
) -> None:
    before = client.put(path, json=SMALL).headers["etag"]
    wrong = edit(client, path, ADD, {"type": "reparent", "id": "w", "parent": "xx"})
    assert wrong.status_code == 422
    assert wrong.headers["content-type"] == "application/problem+json"
    assert wrong.json()["errors"][0]["pointer"] == "/edits/1/parent"
    assert client.get(path).headers["etag"] == before


def test_patches_of_both_kinds(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    merge = client.patch(
        path,
        content=json.dumps({"name": "Another", "style": {"halo": 0.5}}),
        headers={"Content-Type": "application/merge-patch+json"},
    )
    assert (merge.status_code, merge.json()["name"]) == (200, "Another")
    patch = client.patch(
        path,
        content=json.dumps(
            [
                {"op": "test", "path": "/name", "value": "Another"},
                {"op": "replace", "path": "/items/0/label", "value": "XX"},
            ]
        ),
        headers={"Content-Type": "application/json-patch+json"},
    )
    assert patch.json()["changes"]["items"]["changed"] == ["x"]
    lost = client.patch(
        path,
        content=json.dumps([{"op": "test", "path": "/name", "value": "Mine"}]),
        headers={"Content-Type": "application/json-patch+json"},
    )
    assert (lost.status_code, lost.json()["errors"][0]["pointer"]) == (409, "/0")
    other = client.patch(path, json={"name": "?"})
    assert other.status_code == 415
    assert "application/merge-patch+json" in other.headers["accept-patch"]


def test_undo_gives_the_same_bytes(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    views = (path, f"{path}/render", f"{path}/layout")
    states = [[client.get(view).content for view in views]]
    for label in ("one", "two", "three"):
        edit(client, path, {"type": "set_item", "id": "y", "fields": {"label": label}})
        states.append([client.get(view).content for view in views])
    for before in (2, 1, 0):
        undone = client.post(f"{path}/undo")
        assert undone.status_code == 200
        assert [client.get(view).content for view in views] == states[before]
    assert undone.json()["can_undo"] is False
    nothing = client.post(f"{path}/undo")
    assert (nothing.status_code, nothing.json()["type"]) == (
        409,
        "urn:tubeloom:problem:nothing-to-undo",
    )
    for after in (1, 2, 3):
        assert client.post(f"{path}/redo").status_code == 200
        assert [client.get(view).content for view in views] == states[after]
    assert client.post(f"{path}/redo").status_code == 409
    causes = [one["cause"] for one in client.get(f"{path}/revisions").json()["revisions"]]
    assert causes == [*["redo"] * 3, *["undo"] * 3, *["edit"] * 3, "put"]


def test_all_steps_of_a_drag_are_one_change_to_undo(client: httpx.Client, path: str) -> None:
    def drag(x: float, **query: str) -> dict[str, Any]:
        fields = {"position": [x, 0, 0]}
        edits = [{"type": "set_item", "id": "y", "fields": fields}]
        answer = client.post(f"{path}/edits", json={"edits": edits}, params=query)
        assert answer.status_code == 200, answer.text
        found: dict[str, Any] = answer.json()
        return found

    client.put(path, json=SMALL)
    states = [client.get(path).content]
    for x in (1.0, 5.0):
        drag(x, amend="false")
        revisions = [drag(x + step / 4, amend="true")["revision"] for step in range(1, 4)]
        states.append(client.get(path).content)
    assert revisions == [7, 8, 9]
    for before in (1, 0):
        client.post(f"{path}/undo").raise_for_status()
        assert client.get(path).content == states[before]
    assert client.post(f"{path}/undo").status_code == 409
    for after in (1, 2):
        client.post(f"{path}/redo").raise_for_status()
        assert client.get(path).content == states[after]
    drag(9.0, amend="true")
    client.post(f"{path}/undo").raise_for_status()
    assert client.get(path).content == states[2], "what follows a redo is a change of its own"
    wrong = client.post(f"{path}/edits", json={"edits": [ADD]}, params={"amend": "yes"})
    assert wrong.status_code == 400


def test_an_edit_after_an_undo_ends_what_could_be_redone(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    edit(client, path, ADD)
    client.post(f"{path}/undo")
    assert edit(client, path, CONNECT | {"attachments": [{"item": "x"}]}).status_code == 422
    assert client.post(f"{path}/redo").status_code == 200
    client.post(f"{path}/undo")
    edit(client, path, {"type": "set_item", "id": "y", "fields": {"label": "other"}})
    assert client.post(f"{path}/redo").status_code == 409


def test_whoever_changes_another_revision_than_the_newest_is_told(
    client: httpx.Client, path: str
) -> None:
    first = client.put(path, json=SMALL, headers={"If-None-Match": "*"})
    taken = client.put(path, json=SMALL, headers={"If-None-Match": "*"})
    assert (first.status_code, taken.status_code) == (201, 412)
    tag = first.headers["etag"]
    assert edit(client, path, ADD, **{"If-Match": tag}).status_code == 200
    assert edit(client, path, CONNECT, **{"If-Match": tag}).status_code == 412
    assert edit(client, path, CONNECT, **{"If-Match": f"W/{tag}"}).status_code == 412
    assert edit(client, path, CONNECT, **{"If-Match": f'"other", "*", {tag}'}).status_code == 412
    assert edit(client, path, CONNECT, **{"If-Match": "*"}).status_code == 200
    newest = client.get(path).headers["etag"]
    assert client.delete(path, headers={"If-Match": tag}).status_code == 412
    assert client.delete(path, headers={"If-Match": newest}).status_code == 204
    assert edit(client, path, CONNECT, **{"If-Match": "*"}).status_code == 412


def test_a_request_that_is_sent_twice_is_done_once(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    key = {"Idempotency-Key": uuid.uuid4().hex}
    first, second = (edit(client, path, ADD, **key) for _ in range(2))
    assert first.status_code == second.status_code == 200
    assert first.content == second.content
    assert first.headers["etag"] == second.headers["etag"]
    other = edit(client, path, CONNECT, **key)
    assert (other.status_code, other.json()["type"]) == (422, "urn:tubeloom:problem:reused-key")
    assert client.get(f"{path}/revisions").json()["revisions"][0]["revision"] == 2
    gone = [client.delete(path, headers={"Idempotency-Key": "d"}).status_code for _ in range(2)]
    assert gone == [204, 204]


def test_what_was_deleted_is_gone_and_can_be_put_anew(client: httpx.Client, path: str) -> None:
    client.put(path, json=SMALL)
    assert client.delete(path).status_code == 204
    for view in ("", "/render", "/layout", "/revisions", "/events"):
        gone = client.get(path + view)
        assert (gone.status_code, gone.json()["type"]) == (404, "urn:tubeloom:problem:not-stored")
    assert client.delete(path).status_code == 404
    assert client.post(f"{path}/undo").status_code == 404
    assert edit(client, path, ADD).status_code == 404
    anew = client.put(path, json=SMALL)
    assert (anew.status_code, anew.json()["revision"]) == (201, 3)
    assert client.post(f"{path}/undo").status_code == 409


def test_programs_are_listed_a_part_at_a_time(client: httpx.Client) -> None:
    start = uuid.uuid4().hex
    names = [f"zz{start}-{number}" for number in range(5)]
    for name in names:
        client.put(f"/v1/programs/{name}", json=SMALL)
    found: list[str] = []
    after: str | None = f"zz{start}"
    while after is not None:
        page = client.get("/v1/programs", params={"limit": 2, "after": after}).json()
        found.extend(one["id"] for one in page["programs"])
        after = page["next"]
    assert found[:5] == names


@pytest.mark.parametrize("name", ["%20", "a%2Fb", "-a", "a" * 201, "ä"])
def test_ids_are_plain(client: httpx.Client, name: str) -> None:
    wrong = client.put(f"/v1/programs/{name}", json=SMALL)
    assert wrong.status_code in {400, 404}
    assert wrong.headers["content-type"] == "application/problem+json"
