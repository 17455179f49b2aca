"""Jobs end, whoever dies in the midst of them."""

from __future__ import annotations

import json
import signal
from pathlib import Path

from tests.api.job_calls import LONG, PICTURE, at_work, over, program, start, state
from tests.service import Service, running_service, until

SECONDS = "format=png&quality=final&width=320&height=240&samples=96"
"""A render that takes some seconds, so that there is time to disturb it."""


def test_a_job_whose_worker_is_killed_is_done_all_the_same(service: Service) -> None:
    document = program("killed")
    with service.client() as client:
        spent = service.spent()
        job = start(client, SECONDS, document)
        at_work(client, job)
        until(lambda: service.busy_worker(spent)).kill()
        found = over(client, job)
        assert (found["state"], found["attempts"]) == ("done", 2)
        again = start(client, SECONDS, json.dumps(document).encode() + b" ")
        assert over(client, again)["attempts"] == 1
        contents = [client.get(f"{each}/result").content for each in (job, again)]
        assert contents[0] == contents[1]


def test_a_job_whose_workers_all_die_fails(tmp_path: Path) -> None:
    strict = running_service(tmp_path, workers=1, job_attempts=2)
    with strict as service, service.client() as client:
        spent = service.spent()
        job = start(client, LONG, program("killed twice"))
        for attempt in (1, 2):
            until(lambda attempt=attempt: state(client, job)["attempts"] == attempt)  # type: ignore[misc]
            at_work(client, job)
            until(lambda: service.busy_worker(spent)).kill()
        found = over(client, job)
        assert found["state"] == "failed"
        assert found["problem"]["type"] == "urn:tubeloom:problem:worker-lost"
        assert client.get("/healthz").status_code == 200


def test_a_job_outlives_the_service_that_is_killed_and_started_again(tmp_path: Path) -> None:
    with running_service(tmp_path, workers=1) as service:
        with service.client() as client:
            jobs = [start(client, SECONDS, program("left behind")) for _ in range(2)]
            at_work(client, jobs[0])
            done = start(client, PICTURE, program("left waiting"))
        service.process.send_signal(signal.SIGKILL)
        service.process.wait()
    with running_service(tmp_path, workers=1) as service, service.client() as client:
        found = [over(client, job) for job in (*jobs, done)]
        assert [(each["state"], each["attempts"]) for each in found] == [
            ("done", 2),
            ("done", 2),
            ("done", 1),
        ]
        assert len({client.get(f"{job}/result").content for job in jobs}) == 1


def test_a_service_that_ends_in_good_order_leaves_its_jobs_to_the_next(tmp_path: Path) -> None:
    with running_service(tmp_path, workers=1) as service, service.client() as client:
        job = start(client, SECONDS, program("left in order"))
        at_work(client, job)
    with running_service(tmp_path, workers=1) as service, service.client() as client:
        assert state(client, job)["state"] in {"waiting", "running"}
        found = over(client, job)
        assert (found["state"], found["attempts"]) == ("done", 1)
