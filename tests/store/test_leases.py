"""Who works on which jobs, in both databases."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from sqlalchemy import delete

from app.answers import Delta, RenderOptions
from app.errors import Overloaded
from app.output.effort import Effort
from app.output.media import SceneFormat
from app.store import jobs, leases, tables
from app.store.database import Connection, Database

OPTIONS = RenderOptions(
    SceneFormat.WEBP,
    quality="final",
    effort=Effort(samples=7, noise=0.1),
    sweep=("/a=1,2",),
    delta=Delta(1, 2, frozenset({"x"}), frozenset()),
)

LONG, OVER = 60.0, -1.0
"""Seconds of a lease that holds, and of one that has run out."""


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Database]:
    """A database without jobs."""
    if request.param == "sqlite":
        url = f"sqlite:///{tmp_path / 'jobs.db'}"
    else:
        url = request.getfixturevalue("postgres").url
    database = Database(url)
    database.migrate()
    database.do(lambda connection: connection.execute(delete(tables.jobs)))
    yield database
    database.close()


def put(database: Database, digest: str, *, most: int = 1000, owner: str | None = None) -> str:
    """Put a job in line that asks for ``digest``."""
    name = jobs.new_id()
    job = jobs.NewJob(name, digest, owner, digest.encode(), b"layout", OPTIONS, 5.0)
    assert database.do(lambda connection: jobs.create(connection, job, most)).state == "waiting"
    return name


def claim(
    database: Database,
    by: str,
    slots: int = 1,
    seconds: float = LONG,
    at_work: dict[str, bool] | None = None,
) -> leases.Claimed:
    """What a service takes up."""
    return database.do(
        lambda connection: leases.claim(connection, by, seconds, slots, at_work or {}, 2, '"lost"')
    )


def find(database: Database, job: str) -> jobs.Job:
    """How a job is."""
    found = database.do(lambda connection: jobs.find(connection, job), writes=False)
    assert found is not None
    return found


def finish(database: Database, by: str, digest: str) -> frozenset[str]:
    """End jobs that ask for ``digest``, with a result."""

    def work(connection: Connection) -> frozenset[str]:
        return leases.finish(connection, by, digest, result=f"result of {by}")

    return database.do(work)


def test_the_oldest_comes_first_with_all_who_ask_the_same(database: Database) -> None:
    first, second, third = put(database, "a"), put(database, "b"), put(database, "a")
    (task,) = claim(database, "me").tasks
    assert task.jobs == {first, third}
    assert (task.document, task.layout, task.options) == (b"a", b"layout", OPTIONS)
    assert (task.attempts, task.deadline_seconds) == (1, 5.0)
    assert [find(database, job).state for job in (first, second, third)] == [
        "running",
        "waiting",
        "running",
    ]
    late = put(database, "a")
    claimed = claim(database, "me", at_work={"a": True})
    assert claimed.joined == {"a": {late}}
    assert [each.jobs for each in claimed.tasks] == [{second}]


def test_services_that_choose_at_the_same_time_choose_different_jobs(database: Database) -> None:
    made = {put(database, f"digest {number % 10}") for number in range(20)}
    names = [f"service {number}" for number in range(5)]
    with ThreadPoolExecutor(5) as services:
        found = list(services.map(lambda by: claim(database, by, slots=2), names))
    tasks = [task for claimed in found for task in claimed.tasks]
    assert len({task.digest for task in tasks}) == len(tasks) == 10
    assert frozenset().union(*(task.jobs for task in tasks)) == made


def test_only_who_holds_the_lease_ends_a_job_and_only_once(database: Database) -> None:
    job = put(database, "a")
    claim(database, "first", seconds=OVER)
    (again,) = claim(database, "second").tasks
    assert again.jobs == {job}
    assert again.attempts == 2
    assert not finish(database, "first", "a")
    late = put(database, "a")
    assert finish(database, "second", "a") == {job, late}
    assert not finish(database, "second", "a")
    found = find(database, job)
    assert (found.state, found.result, found.share) == ("done", "result of second", 1.0)
    assert not database.do(lambda connection: jobs.cancel(connection, job))


def test_a_job_is_given_up_after_so_many_attempts(database: Database) -> None:
    job = put(database, "a")
    for _ in range(2):
        assert claim(database, "me", seconds=OVER).tasks
    assert claim(database, "you").given_up == {job}
    found = find(database, job)
    assert (found.state, found.problem) == ("failed", '"lost"')


def test_a_service_does_not_take_from_itself(database: Database) -> None:
    put(database, "a")
    claim(database, "me", seconds=OVER)
    assert not claim(database, "me", at_work={"a": True}).tasks
    shares = {"a": ("drawing", 0.5, 1)}
    left = database.do(lambda connection: leases.pulse(connection, "me", LONG, shares))
    assert len(left["a"]) == 1
    assert not claim(database, "you").tasks


def test_who_holds_no_lease_hears_so(database: Database) -> None:
    job = put(database, "a")
    claim(database, "me")
    assert database.do(lambda connection: jobs.cancel(connection, job))
    shares = {"a": ("drawing", 0.5, 1)}
    left = database.do(lambda connection: leases.pulse(connection, "me", LONG, shares))
    assert left == {"a": frozenset()}
    assert find(database, job).state == "cancelled"


def test_what_is_put_back_counts_as_no_attempt(database: Database) -> None:
    job = put(database, "a")
    claim(database, "me")
    database.do(lambda connection: leases.release(connection, "me"))
    assert find(database, job).state == "waiting"
    (task,) = claim(database, "you").tasks
    assert task.attempts == 1


def test_the_line_is_bounded_and_what_is_over_is_forgotten(database: Database) -> None:
    job = put(database, "a", most=1, owner="me")
    with pytest.raises(Overloaded):
        put(database, "b", most=1)
    listed = database.do(lambda connection: jobs.listing(connection, "me", None, 9))
    assert [each.id for each in listed] == [job]
    assert not database.do(lambda connection: jobs.listing(connection, "you", None, 9))
    database.do(lambda connection: jobs.cancel(connection, job))
    future = jobs.now() + 1
    assert database.do(lambda connection: jobs.forget(connection, future)) == 1
    assert database.do(lambda connection: jobs.find(connection, job)) is None
