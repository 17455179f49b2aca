"""News of stored programs: each revision once and in order, whoever was away for a while."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.api.event_streams import Event, events
from tests.service import PATIENCE_SECONDS, SMALL, Service, running_service, until


@pytest.fixture
def path(client: httpx.Client) -> str:
    """Where the small program is."""
    path = f"/v1/programs/{uuid.uuid4().hex}"
    client.put(path, json=SMALL)
    return path


def relabel(client: httpx.Client, path: str, label: str) -> None:
    edit = {"type": "set_item", "id": "y", "fields": {"label": label}}
    client.post(f"{path}/edits", json={"edits": [edit]}).raise_for_status()


def relabel_often(client: httpx.Client, path: str, labels: Iterable[object]) -> None:
    for label in labels:
        relabel(client, path, str(label))


@contextmanager
def watching(
    service: Service, path: str, last: str | None = None, **query: Any
) -> Iterator[Iterator[Event]]:
    headers = {} if last is None else {"Last-Event-ID": last}
    with (
        service.client() as client,
        client.stream("GET", f"{path}/events", params=query, headers=headers) as response,
    ):
        assert response.status_code == 200, response.read()
        assert response.headers["content-type"].startswith("text/event-stream")
        yield events(response)


def test_a_watcher_hears_of_each_revision(
    service: Service, client: httpx.Client, path: str
) -> None:
    with watching(service, path) as heard:
        assert next(heard) == Event("current", {"revision": 1})
        for number in range(2, 6):
            relabel(client, path, str(number))
            event = next(heard)
            assert (event.name, event.data["revision"]) == ("revision", number)
            assert event.data["changes"]["items"]["changed"] == ["y"]
        client.delete(path)
        assert next(heard) == Event("deleted", {"revision": 6})
        assert next(heard, None) is None


def test_who_was_away_misses_nothing(service: Service, client: httpx.Client, path: str) -> None:
    for number in range(2, 8):
        relabel(client, path, str(number))
    with watching(service, path, last="3") as heard:
        assert [next(heard).data["revision"] for _ in range(4)] == [4, 5, 6, 7]
        relabel(client, path, "8")
        assert next(heard).data["revision"] == 8
    with watching(service, path, after=6) as heard:
        assert [next(heard).data["revision"] for _ in range(2)] == [7, 8]


def test_who_comes_from_the_future_starts_anew(service: Service, path: str) -> None:
    with watching(service, path, last="99") as heard:
        assert next(heard) == Event("reset", {"revision": 1})


def test_nobody_watches_what_is_not_there(client: httpx.Client) -> None:
    missing = client.get("/v1/programs/no-such-program/events")
    assert (missing.status_code, missing.json()["type"]) == (404, "urn:tubeloom:problem:not-stored")


def test_who_was_away_for_too_long_is_told(strict: Service) -> None:
    path = "/v1/programs/forgotten"
    with strict.client() as client:
        client.put(path, json=SMALL)
        for number in range(2, 9):
            relabel(client, path, str(number))
        with watching(strict, path, last="2") as heard:
            assert next(heard) == Event("reset", {"revision": 8})
            relabel(client, path, "9")
            assert next(heard).data["revision"] == 9
        whole = client.get(f"{path}/render", params={"since": 2})
        assert "tubeloom-since" not in whole.headers


def test_each_step_of_a_drag_is_told_and_who_missed_some_loads_anew(
    service: Service, client: httpx.Client, path: str
) -> None:
    relabel(client, path, "before")
    with watching(service, path) as heard:
        assert next(heard) == Event("current", {"revision": 2})
        for number in range(3, 43):
            edit = {"type": "set_item", "id": "y", "fields": {"label": str(number)}}
            query = {"amend": "true"} if number > 3 else {}
            client.post(f"{path}/edits", json={"edits": [edit]}, params=query).raise_for_status()
            assert next(heard).data["revision"] == number
    with watching(service, path, last="1") as heard:
        assert next(heard) == Event("reset", {"revision": 42})
    with watching(service, path, last="17") as heard:
        assert next(heard).data["revision"] == 18
    for since, part in ((1, None), (17, "17")):
        render = client.get(f"{path}/render", params={"since": since})
        assert (render.status_code, render.headers.get("tubeloom-since")) == (200, part)


def test_only_so_many_may_watch(strict: Service) -> None:
    path = "/v1/programs/watched"
    with strict.client() as client:
        client.put(path, json=SMALL)
        with ExitStack() as stack:
            streams = [stack.enter_context(watching(strict, path)) for _ in range(4)]
            assert [next(heard).name for heard in streams] == ["current"] * 4
            fifth = client.get(f"{path}/events")
            assert fifth.status_code == 503
            assert "retry-after" in fifth.headers
            # Events of renders and jobs count with them.
            accept = {"accept": "text/event-stream"}
            assert client.post("/v1/render", json=SMALL, headers=accept).status_code == 503
            job = client.post("/v1/jobs", json=SMALL)
            assert client.get(f"{job.headers['location']}/events").status_code == 503
        until(lambda: _may_watch(strict, path))


def _may_watch(service: Service, path: str) -> bool:
    with service.client() as client, client.stream("GET", f"{path}/events") as response:
        return response.status_code == 200


def test_two_services_on_one_database_tell_the_same_and_end_when_asked_to(tmp_path: Path) -> None:
    (tmp_path / "second").mkdir()
    database = f"sqlite:///{tmp_path / 'shared.db'}"
    with (
        running_service(tmp_path, database=database, warm=False) as first,
        running_service(tmp_path / "second", database=database, warm=False) as second,
        first.client() as writer,
    ):
        writer.put("/v1/programs/p", json=SMALL)
        with watching(second, "/v1/programs/p") as heard, watching(first, "/v1/programs/p") as too:
            assert [next(each).data["revision"] for each in (heard, too)] == [1, 1]
            thread = threading.Thread(
                target=relabel_often, args=(writer, "/v1/programs/p", range(2, 8))
            )
            thread.start()
            for each in (heard, too):
                assert [next(each).data["revision"] for _ in range(6)] == [2, 3, 4, 5, 6, 7]
            thread.join(PATIENCE_SECONDS)
            # Its watchers do not keep it.
            second.process.terminate()
            assert next(heard, None) is None
            assert second.process.wait(PATIENCE_SECONDS) is not None
