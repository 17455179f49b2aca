"""Jobs over HTTP: started, followed, fetched, cancelled; and what ends them early."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest

from tests.api.event_streams import events
from tests.api.job_calls import LONG, PICTURE, at_work, over, program, start, state
from tests.service import Service, running_service, spent_until_gone, until


def test_what_a_job_makes_is_what_a_plain_request_gets(client: httpx.Client) -> None:
    document = program("as a plain request")
    job = start(client, PICTURE, document)
    found = over(client, job)
    assert (found["state"], found["share"], found["attempts"]) == ("done", 1.0, 1)
    assert found["created_at"] < found["started_at"] < found["finished_at"]
    made = client.get(found["links"]["result"])
    plain = client.post(f"/v1/render?{PICTURE}", json=document)
    assert made.content == plain.content
    for name in ("content-type", "etag", "content-disposition", "tubeloom-samples"):
        assert made.headers[name] == plain.headers[name]
    again = client.get(f"{job}/result", headers={"if-none-match": made.headers["etag"]})
    assert again.status_code == 304


def test_there_is_no_result_before_the_end(client: httpx.Client) -> None:
    job = start(client, LONG, program("asked for too early"))
    early = client.get(f"{job}/result")
    assert early.status_code == 409
    assert early.json()["type"] == "urn:tubeloom:problem:job-not-done"
    client.delete(job)


def test_events_tell_how_a_job_goes_on(client: httpx.Client) -> None:
    job = start(client, LONG, program("watched"))  # it does not end before it is cancelled
    shares: list[float] = []
    with client.stream("GET", f"{job}/events") as response:
        assert response.headers["content-type"].startswith("text/event-stream")
        heard = events(response)
        while len(set(shares)) < 3:
            event = next(heard)
            assert event.name in {"waiting", "progress"}
            if event.name == "progress":
                shares.append(event.data["share"])
        assert shares == sorted(shares)
        assert shares[-1] < 1
        assert client.delete(job).status_code == 204
        assert list(heard)[-1].name == "cancelled"


def test_events_tell_how_a_job_ends(client: httpx.Client) -> None:
    job = start(client, PICTURE, program("awaited"))
    with client.stream("GET", f"{job}/events") as response:
        told = list(events(response))
    # How much a quick job tells of its way depends on how quick it is.
    shares = [event.data["share"] for event in told if event.name == "progress"]
    assert shares == sorted(shares)
    assert [event.name for event in told if event.name not in {"waiting", "progress"}] == ["done"]
    assert told[-1].data["state"] == "done"


def test_who_comes_late_hears_how_a_job_is_now(client: httpx.Client) -> None:
    job = start(client, LONG, program("late"))
    at_work(client, job)
    with client.stream("GET", f"{job}/events") as response:
        heard = events(response)
        first = next(heard)
        assert first.name == "progress"
        assert first.data["share"] >= 0.6
        assert client.delete(job).status_code == 204
        assert list(heard)[-1].name == "cancelled"
    with client.stream("GET", f"{job}/events") as response:
        assert [event.name for event in events(response)] == ["cancelled"]


def test_who_cancels_a_job_frees_the_processor_within_a_second(service: Service) -> None:
    with service.client() as client:
        spent = service.spent()
        job = start(client, LONG, program("to be cancelled"))
        at_work(client, job)
        busy = until(lambda: service.busy_worker(spent))
        assert client.delete(job).status_code == 204
        assert spent_until_gone(busy) < 1.0
        assert state(client, job)["state"] == "cancelled"
        assert client.get(f"{job}/result").status_code == 409
        assert client.delete(job).status_code == 204


def test_a_job_that_fails_says_why(client: httpx.Client) -> None:
    job = start(client, "format=glb", b'{"items": 1}')
    found = over(client, job)
    assert found["state"] == "failed"
    assert found["problem"]["type"] == "urn:tubeloom:problem:invalid-document"
    assert found["problem"]["errors"][0]["pointer"] == "/items"
    plain = client.get(f"{job}/result")
    assert plain.status_code == 400
    assert plain.json()["errors"] == [{"pointer": "/items", "detail": "Must be a list, not 1."}]
    with client.stream("GET", f"{job}/events") as response:
        (last,) = events(response)
    assert last.name == "failed"
    assert last.data["problem"]["status"] == 400


def test_the_same_is_worked_on_once_however_many_ask(service: Service) -> None:
    document = program("asked by many")
    with service.client() as client, ThreadPoolExecutor(8) as people:
        service.spent()  # nobody's work goes on any more
        before = made_by_workers(service)
        jobs = list(people.map(lambda _: start(client, PICTURE, document), range(8)))
        assert len(set(jobs)) == 8
        assert {over(client, job)["state"] for job in jobs} == {"done"}
        assert len({client.get(f"{job}/result").content for job in jobs}) == 1
        assert made_by_workers(service) - before == 1
        last = start(client, PICTURE, document)
        assert over(client, last)["state"] == "done"
        assert made_by_workers(service) - before == 1


def made_by_workers(service: Service) -> float:
    """How many final pictures the workers of jobs have made since they started."""
    with service.client() as client:
        lines = client.get("/metrics").text.splitlines()
    name = "tubeloom_work_seconds_count"
    return sum(float(line.rpartition(" ")[2]) for line in lines if line.startswith(name))


def test_of_two_who_ask_the_same_one_may_leave(client: httpx.Client) -> None:
    document = program("asked by two")
    first, second = start(client, LONG, document), start(client, LONG, document)
    at_work(client, first)
    at_work(client, second)
    client.delete(first)
    assert state(client, first)["state"] == "cancelled"
    share = state(client, second)["share"]
    assert share >= 0.6
    until(lambda: state(client, second)["share"] > share)
    client.delete(second)


def test_a_request_that_comes_twice_starts_one_job(client: httpx.Client) -> None:
    document, key = program("sent twice"), {"idempotency-key": "sent-twice"}
    first, second = (start(client, PICTURE, document, **key) for _ in range(2))
    assert first == second
    other = client.post("/v1/jobs?format=glb", json=program("other"), headers=key)
    assert other.status_code == 422
    assert other.json()["type"] == "urn:tubeloom:problem:reused-key"


def test_a_stored_program_is_rendered_as_it_is_stored(client: httpx.Client) -> None:
    document = program("stored for a job")
    assert client.put("/v1/programs/for-a-job", json=document).status_code == 201
    response = client.post("/v1/jobs?program=for-a-job&format=glb")
    assert response.status_code == 202, response.text
    job = response.headers["location"]
    assert over(client, job)["state"] == "done"
    plain = client.get("/v1/programs/for-a-job/render?format=glb")
    assert client.get(f"{job}/result").content == plain.content
    assert client.post("/v1/jobs?program=there-is-none").status_code == 404
    both = client.post("/v1/jobs?program=for-a-job", json=document)
    assert both.status_code == 422
    assert client.post("/v1/jobs?revision=1", json=document).status_code == 422


def test_jobs_are_listed_a_part_at_a_time(client: httpx.Client) -> None:
    started = [start(client, "format=glb", program(f"listed {number}")) for number in range(3)]
    first = client.get("/v1/jobs?limit=2").json()
    assert [job["links"]["self"] for job in first["jobs"]] == [started[2], started[1]]
    second = client.get(f"/v1/jobs?limit=2&before={first['next']}").json()
    assert second["jobs"][0]["links"]["self"] == started[0]


def test_a_job_that_there_is_not(client: httpx.Client) -> None:
    for path in ("", "/events", "/result"):
        response = client.get(f"/v1/jobs/{'0' * 32}{path}")
        assert response.status_code == 404
        assert response.json()["type"] == "urn:tubeloom:problem:not-stored"
    assert client.get("/v1/jobs/no-such-id").status_code == 400


def test_what_would_take_long_becomes_a_job_if_the_client_prefers_that(
    client: httpx.Client,
) -> None:
    document = program("preferred")
    prefer = {"prefer": "wait=2, respond-async"}
    response = client.post(f"/v1/render?{LONG}", json=document, headers=prefer)
    assert response.status_code == 202
    assert response.headers["preference-applied"] == "respond-async, wait=2"
    job = response.headers["location"]
    assert response.json()["links"]["self"] == job
    client.delete(job)
    quick = client.post("/v1/render?format=glb", json=document, headers=prefer)
    assert quick.status_code == 200
    assert quick.content.startswith(b"glTF")
    patient = client.post(f"/v1/render?{PICTURE}", json=document)
    assert patient.headers["content-type"] == "image/png"


@pytest.fixture(scope="module")
def scarce(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service whose jobs have little of everything; only its workers for jobs are of use."""
    with running_service(
        tmp_path_factory.mktemp("scarce"),
        warm=False,
        max_jobs_waiting=1,
        job_deadline_seconds=6,
    ) as running:
        with running.client() as client:  # the deadline counts the start of the worker, too
            until(lambda: over(client, start(client, "format=glb", program("")))["state"] == "done")
        yield running


FILM = "format=webp&width=640&height=480&frames=1000"
"""A render that takes minutes."""


def test_too_many_jobs_are_refused(scarce: Service) -> None:
    with scarce.client() as client:

        def refused() -> httpx.Response | None:
            """The refusal of one job beside two others, unless these were over meanwhile."""
            first = start(client, FILM, program("first"))
            until(lambda: state(client, first)["state"] != "waiting")
            second = start(client, FILM, program("second"))
            third = client.post(f"/v1/jobs?{FILM}", json=program("third"))
            for job in (first, second, third.headers.get("location")):
                if job is not None:
                    client.delete(job)
            return third if third.status_code != 202 else None

        third = until(refused)
        assert third.status_code == 503
        assert third.json()["type"] == "urn:tubeloom:problem:overloaded"
        assert float(third.headers["retry-after"]) > 0
        # There is room again.
        client.delete(start(client, FILM, program("fourth")))


def test_what_takes_too_long_fails(scarce: Service) -> None:
    with scarce.client() as client:
        found = over(client, start(client, FILM, program("too long")))
        assert found["state"] == "failed"
        assert found["problem"]["type"] == "urn:tubeloom:problem:deadline-exceeded"
        assert "6 seconds" in found["problem"]["detail"]
