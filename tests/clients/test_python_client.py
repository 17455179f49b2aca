"""The client for Python, against the real service."""

from __future__ import annotations

import json
import re
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from tubeloom_client import (
    Busy,
    Client,
    Current,
    Deleted,
    Fault,
    JobCancelled,
    JobFailed,
    JobState,
    LostRace,
    NotAllowed,
    NotFound,
    Problem,
    Reset,
    Sets,
    Unreachable,
)

from tests.clients.ports import free_port
from tests.clients.watching import Watcher
from tests.service import PATIENCE_SECONDS, SMALL, Service, until

FINAL: dict[str, Any] = {"quality": "final", "width": 64, "height": 48, "samples": 1}
LONG: dict[str, Any] = {"quality": "final", "width": 320, "height": 240, "samples": 65536}


@pytest.fixture(scope="module")
def client(service: Service) -> Iterator[Client]:
    with Client(service.url) as client:
        yield client


def test_a_document_becomes_a_picture_and_a_scene(client: Client) -> None:
    picture = client.render(SMALL, format="png", width=64, height=48)
    assert picture.startswith(b"\x89PNG")
    assert client.render(json.dumps(SMALL).encode()).startswith(b"glTF")
    sweep = client.render(SMALL, format="png", width=64, height=48, sweep=["/style/halo=0,0.5"])
    assert sweep.startswith(b"\x89PNG")
    assert sweep != picture


def test_a_document_becomes_numbers(client: Client) -> None:
    layout = client.layout(SMALL, patches=True)
    assert [item.id for item in layout.items] == ["x", "y", "z"]
    (hyperedge,) = layout.hyperedges
    assert re.fullmatch("#[0-9a-f]{6}", hyperedge.color)
    assert [attachment.item for attachment in hyperedge.attachments] == ["x", "y", "z"]
    ends = {segment.from_.attachment for segment in hyperedge.segments}
    assert ends & {0, 1, 2}
    assert hyperedge.segments[0].patches
    assert layout.clearance is not None
    assert layout.clearance.certified
    assert layout.clearance.minimum >= layout.clearance.required


def test_documents_are_converted_and_what_there_is_is_listed(client: Client) -> None:
    hif = client.convert(SMALL, to="hif")
    assert {node["node"] for node in hif["nodes"]} == {"x", "y", "z"}
    back = client.convert(hif, source="hif")
    assert [item["id"] for item in back["items"]] == ["x", "y", "z"]
    assert {"plain", "sparcl"} <= {each["name"] for each in client.catalogue("notations")}


def test_a_bad_document_is_a_problem_that_says_where(client: Client) -> None:
    with pytest.raises(Problem) as caught:
        client.render({"items": [{"id": "a"}, {"id": "a"}]})
    assert (caught.value.status, caught.value.name) == (422, "inconsistent-document")
    assert [fault.pointer for fault in caught.value.errors] == ["/items/1/id"]
    with pytest.raises(Problem) as caught:
        client.render(SMALL, width=0)
    assert caught.value.status == 400
    (fault,) = caught.value.errors
    assert isinstance(fault, Fault)
    assert fault.parameter == "width"


def test_a_stored_program_is_put_edited_undone_and_redone(client: Client) -> None:
    program = client.program("changed")
    with pytest.raises(NotFound):
        program.get()
    first = program.create(SMALL)
    assert (first.revision, first.cause, first.item_count) == (1, "put", 3)
    with pytest.raises(LostRace):
        program.create(SMALL)
    second = program.edit(
        {"type": "add_item", "item": {"id": "w"}},
        {"type": "connect", "id": "e", "attachments": [{"item": "w"}]},
    )
    assert second.changes.items.added == ("w",)
    assert "e" in second.changes.hyperedges.changed
    assert (second.can_undo, second.can_redo) == (True, False)
    edited = program.get()
    third = program.undo()
    assert third.digest == first.digest
    assert third.changes.items == Sets(removed=("w",))
    fourth = program.redo()
    assert fourth.digest == second.digest
    assert program.get() == edited
    assert [each.revision for each in program.revisions()] == [4, 3, 2, 1]
    assert program.get(revision=3)["items"] != edited["items"]
    fifth = program.patch({"name": "Renamed"})
    assert fifth.name == "Renamed"
    sixth = program.patch([{"op": "replace", "path": "/name", "value": "Again"}])
    assert sixth.created_at >= fifth.created_at
    assert [each.revision for each in program.revisions()] == [6, 5, 4, 3, 2]
    listed = {each.id: each for each in client.programs()}
    assert (listed[program.id].revision, listed[program.id].name) == (6, "Again")
    assert listed[program.id].updated_at == sixth.created_at
    program.delete()
    with pytest.raises(NotFound):
        program.get()


def test_edits_that_amend_are_one_change_to_undo(client: Client) -> None:
    program = client.program("amended")
    first = program.put(SMALL)
    for number, amend in ((0, False), (1, True), (2, True)):
        change = program.amend if amend else program.edit
        change({"type": "set_item", "id": "y", "fields": {"label": str(number)}})
    assert program.undo().digest == first.digest
    assert program.redo().revision == 6


def test_a_stored_program_is_looked_at(client: Client) -> None:
    program = client.program("looked-at")
    program.put(SMALL)
    before = program.render()
    program.edit({"type": "set_item", "id": "y", "fields": {"label": "Y"}})
    assert program.render(revision=1) == before
    assert len(program.render(since=1)) < len(program.render())
    assert program.render(format="png", width=64, height=48).startswith(b"\x89PNG")
    assert [item.id for item in program.layout().items] == ["x", "y", "z"]


def test_of_two_who_change_a_program_the_slower_one_hears_of_it(client: Client) -> None:
    mine, yours = client.program("raced"), client.program("raced")
    mine.put(SMALL)
    yours.get()
    mine.patch({"name": "Mine"})
    with pytest.raises(LostRace) as caught:
        yours.patch({"name": "Yours"})
    assert caught.value.status == 412
    revision = yours.update(lambda document: {**document, "name": document["name"] + " and yours"})
    assert (revision.revision, revision.name) == (3, "Mine and yours")


def test_all_who_update_at_the_same_time_have_their_way(client: Client) -> None:
    client.program("contended").put(SMALL)

    def add(name: str) -> None:
        client.program("contended").update(
            lambda document: {**document, "items": [*document["items"], {"id": name}]}
        )

    writers = [threading.Thread(target=add, args=(f"w{number}",)) for number in range(4)]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join(PATIENCE_SECONDS)
    items = client.program("contended").get()["items"]
    assert {item["id"] for item in items} >= {"w0", "w1", "w2", "w3"}


def test_a_watcher_hears_of_everything_until_the_end(client: Client) -> None:
    program = client.program("heard-of")
    program.put(SMALL)
    watcher = Watcher(client.program("heard-of"))
    assert watcher.next() == Current(1)
    made = [program.patch({"name": "A"}), program.undo()]
    program.delete()
    assert watcher.all() == [*made, Deleted(4)]


def test_a_watcher_that_was_away_for_too_long_is_told_to_load_anew(client: Client) -> None:
    program = client.program("long-ago")
    program.put(SMALL)
    for number in range(7):
        program.patch({"name": str(number)})
    watching = program.watch(after=1)
    assert next(watching) == Reset(8)
    watching.close()
    watching = program.watch(after=6)
    assert [next(watching).revision for _ in range(2)] == [7, 8]


def test_a_job_is_started_followed_and_fetched(client: Client) -> None:
    job = client.start({**SMALL, "name": "Job"}, **FINAL)
    states: list[JobState] = []
    picture = job.wait(states.append)
    assert picture.startswith(b"\x89PNG")
    assert (states[-1].state, states[-1].share, states[-1].problem) == ("done", 1.0, None)
    assert job.state().state == "done"
    assert client.job(job.id).result() == picture
    shares = [state.share for state in states]
    assert shares == sorted(shares)


def test_a_stored_program_is_rendered_by_a_job(client: Client) -> None:
    program = client.program("by-a-job")
    program.put(SMALL)
    assert program.start(format="glb").wait() == program.render()


def test_a_job_that_fails_or_is_cancelled_says_so(client: Client) -> None:
    with pytest.raises(JobFailed) as caught:
        client.run({"items": [{"id": "a"}, {"id": "a"}]})
    assert caught.value.name == "inconsistent-document"
    assert caught.value.errors[0].pointer == "/items/1/id"
    job = client.start({**SMALL, "name": "Cancelled"}, **LONG)
    with pytest.raises(Problem) as early:
        job.result()
    assert early.value.status == 409
    job.cancel()
    with pytest.raises(JobCancelled):
        job.wait()


def test_who_stops_waiting_cancels_the_job(client: Client) -> None:
    seen: list[str] = []

    def lose_patience(state: JobState) -> None:
        seen.append(state.id)
        if state.state == "running":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        client.run({**SMALL, "name": "Impatient"}, progress=lose_patience, **LONG)
    assert client.job(seen[0]).state().state == "cancelled"


def test_keys_are_sent_and_missed(guarded: tuple[Service, str]) -> None:
    service, key = guarded
    with Client(service.url) as client, pytest.raises(NotAllowed) as caught:
        client.layout(SMALL)
    assert caught.value.status == 401
    with Client(service.url, key="wrong") as client, pytest.raises(NotAllowed):
        client.layout(SMALL)
    with Client(service.url, key=key) as client:
        assert client.layout(SMALL).items


def test_a_busy_service_is_asked_again_for_as_long_as_one_likes(
    guarded: tuple[Service, str],
) -> None:
    service, key = guarded
    with Client(service.url, key=key, patience=30.0) as patient:
        assert [len(patient.render(SMALL)) > 0 for _ in range(5)] == [True] * 5

    def refused(_: int) -> Busy | None:
        with Client(service.url, key=key, patience=0.0) as hasty:
            try:
                hasty.layout(SMALL)
            except Busy as busy:
                return busy
        return None

    # A slow machine may take as long for each as the rate wants: so they all ask at once.
    with ThreadPoolExecutor(8) as people:
        busy = until(lambda: next(filter(None, people.map(refused, range(8))), None))
    assert busy.retry_after is not None
    assert 0 < busy.retry_after <= 3


def test_where_nobody_listens_patience_runs_out() -> None:
    with Client(f"http://127.0.0.1:{free_port()}", patience=0.5) as client:
        start = time.monotonic()
        with pytest.raises(Unreachable):
            client.layout(SMALL)
        assert time.monotonic() - start > 0.25
