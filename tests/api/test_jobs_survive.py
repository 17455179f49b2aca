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

from tests.api.job_calls import (
    LONG,
    OVER,
    PERIODS,
    PICTURE,
    at_work,
    caught,
    over,
    program,
    start,
    state,
    watched,
)
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
    assert any(_outlive(home, seconds) for seconds in PERIODS)


def _outlive(home: Home, seconds: int) -> bool:
    """Whether jobs of so many ``seconds`` were at work when their service died. All are done."""
    killed, document = home.service, program("left behind")
    kept = scenes_kept(home.data)
    with killed.client() as client:
        answered = client.post("/v1/render", json=document)
        assert answered.headers["tubeloom-cache"] == "miss"
        until(lambda: scenes_kept(home.data) > kept)
        jobs = [start(client, watched(seconds), document) for _ in range(2)]
        was_caught = caught(client, jobs[0])
        waiting = start(client, PICTURE, program("left waiting"))
    workers = until(lambda: found if len(found := killed.workers()) == 2 else None)
    killed.process.send_signal(signal.SIGKILL)
    until(lambda: all(gone(worker) for worker in workers))
    with home.start_again().client() as client:
        found = [over(client, job) for job in (*jobs, waiting)]
        assert {each["state"] for each in found} == {"done"}
        if not was_caught or found[0]["attempts"] == 1:
            return False
        assert [each["attempts"] for each in found] == [2, 2, 1]
        assert len({client.get(f"{job}/result").content for job in jobs}) == 1
        # Nobody had to work for it again.
        again = client.post("/v1/render", json=document)
        assert again.headers["tubeloom-cache"] == "hit"
        assert again.content == answered.content
    return True


def scenes_kept(data: Path) -> int:
    """How many scenes the database knows of: an answer is written after it was given."""
    with closing(sqlite3.connect(data / "tubeloom.db")) as database:
        found = database.execute("SELECT key FROM results WHERE media_type = 'model/gltf-binary'")
        return len(found.fetchall())


def test_a_service_that_ends_in_good_order_leaves_its_jobs_to_the_next(home: Home) -> None:
    assert any(_left_to_next(home, seconds) for seconds in PERIODS)


def _left_to_next(home: Home, seconds: int) -> bool:
    """Whether a job of so many ``seconds`` goes on in the next service. It is done."""
    with home.service.client() as client:
        job = start(client, watched(seconds), program("left in order"))
        was_caught = caught(client, job)
    with home.start_again().client() as client:
        is_left = state(client, job)["state"] in {"waiting", "running"}
        found = over(client, job)
        assert (found["state"], found["attempts"]) == ("done", 1)
    return was_caught and is_left
