"""Jobs end, whoever dies in the midst of them; and answers are kept."""

from __future__ import annotations

import json
import signal
import sqlite3
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest

from tests.api.job_calls import LONG, OVER, PICTURE, WATCHED, at_work, over, program, start, state
from tests.service import Service, gone, running_service, until

SAMPLED = "format=png&quality=final&width=96&height=72&samples="
"""A render that gives the same bytes each time; how long it takes depends on the machine."""


class Home:
    """A service that may be started again, with all that it had stored."""

    def __init__(self, folder: Path) -> None:
        self.data = folder / "data"
        self._folder = folder
        self._running = ExitStack()
        self.service = self._started(warm=True)

    def start_again(self) -> Service:
        """Another service in place of this one, which ends in good order if it is still there.

        Only its workers for jobs are of use, so no others are waited for.
        """
        self.end()
        self.service = self._started(warm=False)
        return self.service

    def end(self) -> None:
        """In good order."""
        self._running.close()

    def _started(self, *, warm: bool) -> Service:
        starting = running_service(
            self._folder, warm=warm, workers=1, job_attempts=2, job_lease_seconds=3
        )
        return self._running.enter_context(starting)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Home]:
    """A service of this module's own: whoever else shared it would see it die."""
    found = Home(tmp_path_factory.mktemp("home"))
    yield found
    found.end()


def test_a_job_whose_worker_is_killed_is_done_all_the_same(home: Home) -> None:
    service = home.service

    def killed(query: str) -> tuple[dict[str, Any], str] | None:
        """A document and its job, whose worker died over it; none where the job was quicker."""
        document, spent = program("killed"), service.spent()
        job = start(client, query, document)
        until(lambda: service.busy_worker(spent) or state(client, job)["state"] in OVER)
        for worker in filter(None, [service.busy_worker(spent)]):
            worker.kill()
        found = over(client, job)
        assert found["state"] == "done"
        return (document, job) if found["attempts"] == 2 else None

    with service.client() as client:
        queries = (f"{SAMPLED}{96 << doublings}" for doublings in range(10))
        query, (document, job) = next(
            (query, found) for query in queries if (found := killed(query))
        )
        again = start(client, query, json.dumps(document).encode() + b" ")
        assert over(client, again)["attempts"] == 1
        contents = [client.get(f"{each}/result").content for each in (job, again)]
        assert contents[0] == contents[1]


def test_a_job_whose_workers_all_die_fails(home: Home) -> None:
    service = home.service
    with service.client() as client:
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


def test_jobs_and_answers_outlive_the_service_that_is_killed_and_its_workers_do_not(
    home: Home,
) -> None:
    killed, document = home.service, program("left behind")
    with killed.client() as client:
        answered = client.post("/v1/render", json=document)
        assert answered.headers["tubeloom-cache"] == "miss"
        until(lambda: is_scene_kept(home.data))
        jobs = [start(client, WATCHED, document) for _ in range(2)]
        at_work(client, jobs[0])
        waiting = start(client, PICTURE, program("left waiting"))
    workers = killed.workers()
    assert len(workers) == 2
    killed.process.send_signal(signal.SIGKILL)
    until(lambda: all(gone(worker) for worker in workers))
    with home.start_again().client() as client:
        found = [over(client, job) for job in (*jobs, waiting)]
        assert [(each["state"], each["attempts"]) for each in found] == [
            ("done", 2),
            ("done", 2),
            ("done", 1),
        ]
        assert len({client.get(f"{job}/result").content for job in jobs}) == 1
        # Nobody had to work for it again.
        again = client.post("/v1/render", json=document)
        assert again.headers["tubeloom-cache"] == "hit"
        assert again.content == answered.content


def is_scene_kept(data: Path) -> bool:
    """Whether the database knows of a scene: an answer is written after it was given."""
    with closing(sqlite3.connect(data / "tubeloom.db")) as database:
        found = database.execute("SELECT key FROM results WHERE media_type = 'model/gltf-binary'")
        return bool(found.fetchall())


def test_a_service_that_ends_in_good_order_leaves_its_jobs_to_the_next(home: Home) -> None:
    with home.service.client() as client:
        job = start(client, WATCHED, program("left in order"))
        at_work(client, job)
    with home.start_again().client() as client:
        assert state(client, job)["state"] in {"waiting", "running"}
        found = over(client, job)
        assert (found["state"], found["attempts"]) == ("done", 1)
