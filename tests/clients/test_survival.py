"""Clients of a service that is killed and started again: nothing is lost, and nothing told twice.

A service takes long to start: whatever they do with one, they do at the same time.
"""

from __future__ import annotations

import json
import threading
from contextlib import ExitStack
from dataclasses import dataclass
from queue import Queue
from typing import Any

import pytest
from tubeloom_client import Client, Current, Deleted, Happening, JobState, Revision

from tests.api.job_calls import DRAWING, PERIODS, lasting
from tests.clients.ports import free_port
from tests.clients.typescript_package import can_run, require_node
from tests.clients.watching import Watcher, heard, watching_in_node
from tests.service import PATIENCE_SECONDS, SMALL, running_service, until

SMALL_PICTURE: dict[str, Any] = {"quality": "final", "width": 96, "height": 72}


@dataclass(frozen=True)
class Story:
    """What became of it: revisions that were made, and what watchers heard since the death."""

    made: list[Revision]
    heard: list[Happening]
    told: list[dict[str, Any]] | None
    picture: bytes
    states: list[JobState]


@pytest.fixture(scope="module")
def story(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> Story:
    folder, port = tmp_path_factory.mktemp("outlives"), free_port()
    settings: dict[str, Any] = {"port": port, "job_lease_seconds": 3}
    drivers = request.getfixturevalue("drivers") if can_run() else None
    made: list[Revision] = []
    states: list[JobState] = []
    pictures: Queue[bytes] = Queue()
    with ExitStack() as stack:
        client = stack.enter_context(Client(f"http://127.0.0.1:{port}", patience=PATIENCE_SECONDS))
        program = client.program("outlives")
        with running_service(folder, **settings) as service:
            made.append(program.put(SMALL))
            watcher = Watcher(client.program("outlives"))
            assert watcher.next() == Current(1)
            node = None
            if drivers is not None:
                node = stack.enter_context(watching_in_node(drivers, service, "outlives"))
                assert heard(node) == {"kind": "current", "revision": 1}
            made.append(program.patch({"name": "before"}))
            assert watcher.next() == made[-1]
            assert node is None or heard(node)["name"] == "before"
            for seconds in PERIODS:
                states.clear()
                job = client.start(SMALL, **SMALL_PICTURE, **lasting(seconds))
                follower = threading.Thread(
                    target=lambda job=job: pictures.put(job.wait(states.append))
                )
                follower.start()
                until(lambda: states and states[-1].share > DRAWING)
                if not states[-1].is_over:
                    break
                pictures.get(timeout=PATIENCE_SECONDS)
            service.kill()
        # Whoever writes meanwhile goes on as soon as there is a service again, and writes once.
        writer = threading.Thread(target=lambda: made.append(program.patch({"name": "meanwhile"})))
        writer.start()
        with running_service(folder, warm=False, **settings):
            writer.join(PATIENCE_SECONDS)
            made += [program.patch({"name": str(number)}) for number in range(20)]
            # Of a program that is gone there are no revisions left to catch up on.
            since = [watcher.next() for _ in made[2:]]
            told = None if node is None else [heard(node) for _ in made[2:]]
            program.delete()
            if node is not None and told is not None:
                told += [json.loads(line) for line in node.rest()]
            picture = pictures.get(timeout=2 * PATIENCE_SECONDS)
            follower.join(PATIENCE_SECONDS)
            return Story(made, [*since, *watcher.all()], told, picture, states)


def test_whoever_writes_meanwhile_writes_once(story: Story) -> None:
    assert [each.revision for each in story.made] == list(range(1, 24))


def test_a_watcher_misses_nothing(story: Story) -> None:
    assert story.heard == [*story.made[2:], Deleted(24)]


def test_a_watcher_in_typescript_misses_nothing(story: Story) -> None:
    require_node()
    assert story.told is not None
    assert [each["revision"] for each in story.told] == list(range(3, 25))
    names = ["meanwhile", *(str(number) for number in range(20))]
    assert [each["name"] for each in story.told[:-1]] == names
    assert story.told[-1] == {"kind": "deleted", "revision": 24}


def test_a_job_is_followed_until_it_is_done(story: Story) -> None:
    assert story.picture.startswith(b"\x89PNG")
    assert (story.states[-1].state, story.states[-1].attempts) == ("done", 2)
