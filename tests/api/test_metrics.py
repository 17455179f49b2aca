from collections.abc import Mapping

import httpx
from prometheus_client.parser import text_string_to_metric_families

from tests.api.job_calls import LONG, program, start
from tests.service import SMALL, fresh, until


def samples(client: httpx.Client) -> Mapping[tuple[str, frozenset[tuple[str, str]]], float]:
    response = client.get("/metrics")
    assert response.status_code == 200
    assert response.headers["content-type"].startswith("text/plain; version=0.0.4")
    return {
        (sample.name, frozenset(sample.labels.items())): sample.value
        for family in text_string_to_metric_families(response.text)
        for sample in family.samples
    }


def labels(**values: str) -> frozenset[tuple[str, str]]:
    return frozenset(values.items())


def test_requests_and_their_stages_are_counted(client: httpx.Client) -> None:
    rendered = labels(method="POST", route="/v1/render", status="200")
    before = samples(client)
    assert (
        client.post("/v1/render", json={**SMALL, "name": fresh("Not seen before")}).status_code
        == 200
    )
    assert client.post("/v1/render", content=b"no").status_code == 400
    after = samples(client)

    def grown(name: str, by: frozenset[tuple[str, str]] = frozenset()) -> float:
        return after[name, by] - before.get((name, by), 0.0)

    assert grown("tubeloom_requests_total", rendered) == 1
    assert (
        grown("tubeloom_requests_total", labels(method="POST", route="/v1/render", status="400"))
        == 1
    )
    timed = labels(method="POST", route="/v1/render")
    assert grown("tubeloom_request_seconds_count", timed) == 2
    assert grown("tubeloom_request_seconds_sum", timed) > 0
    assert grown("tubeloom_work_seconds_count") >= 2
    stages = {dict(by)["stage"] for name, by in after if name == "tubeloom_stage_seconds_sum"}
    assert "reading" in stages, stages
    assert len(stages) > 3


def test_workers_are_counted(client: httpx.Client) -> None:
    found = samples(client)
    assert found["tubeloom_workers", labels(state="wanted")] == 2
    until(lambda: samples(client)["tubeloom_workers", labels(state="warm")] == 2)
    assert ("tubeloom_workers", labels(state="busy")) in found
    assert found["tubeloom_waiting", frozenset()] == 0
    assert ("tubeloom_workers_lost_total", frozenset()) in found
    assert found["process_open_fds", frozenset()] > 0


def test_what_is_asked_again_is_counted_as_such(client: httpx.Client) -> None:
    before = samples(client)
    document = {**SMALL, "name": fresh("Asked twice")}
    for _ in range(2):
        assert client.post("/v1/layout", json=document).status_code == 200
    after = samples(client)
    for outcome, grown in (("hit", 1), ("miss", 1), ("shared", 0)):
        key = ("tubeloom_cache_total", labels(outcome=outcome))
        assert after[key] - before[key] == grown


def test_jobs_and_who_follows_them_are_counted(client: httpx.Client) -> None:
    def jobs(state: str) -> float:
        return samples(client)["tubeloom_jobs", labels(state=state)]

    def viewers() -> float:
        return samples(client)["tubeloom_event_viewers", frozenset()]

    until(lambda: jobs("running") == jobs("waiting") == 0)
    before = viewers()
    job = start(client, LONG, program("Worked on for long, to be counted"))
    until(lambda: jobs("running") == 1)
    other = start(client, LONG, program("Waits, to be counted"))
    until(lambda: jobs("waiting") == 1)
    assert client.put("/v1/programs/watched", json=SMALL).is_success
    with (
        client.stream("GET", f"{job}/events"),
        client.stream("GET", "/v1/programs/watched/events"),
    ):
        until(lambda: viewers() == before + 2)
    until(lambda: viewers() == before)
    for each in (job, other):
        assert client.delete(each).status_code == 204
    until(lambda: jobs("running") == jobs("waiting") == 0)


def test_what_strangers_ask_adds_no_more_than_one_line(client: httpx.Client) -> None:
    def ask(number: int) -> None:
        client.get(f"/wp-admin/{number}")
        client.get(f"/v1/jobs/{number}")
        client.request(f"BREW{number}", f"/coffee/{number}")
        client.post(f"/v1/render?format={number}", json=SMALL)

    ask(0)
    before = len(samples(client))
    for number in range(1, 50):
        ask(number)
    assert len(samples(client)) == before
