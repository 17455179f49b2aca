"""Who works on which jobs. The functions want a connection of `app.store.database`.

Jobs that ask the same thing have the same digest and are worked on together, once. Whoever works
on one holds a lease: where it runs out, the worker is gone, and another takes the job up. Only who
holds the lease may end a job, so none is ended twice.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sqlalchemy import ColumnElement, Connection, case, func, or_, select, update

from app.answers import RenderOptions
from app.store.deflating import deflater
from app.store.jobs import OPTIONS, now, one_at_a_time
from app.store.tables import jobs


@dataclass(frozen=True, slots=True)
class Task:
    """What is to be done for all ``jobs`` that ask the same."""

    digest: str
    jobs: frozenset[str]
    attempts: int
    document: bytes
    layout: bytes | None
    options: RenderOptions
    deadline_seconds: float


@dataclass(frozen=True, slots=True)
class Claimed:
    """New tasks; jobs that join what is worked on already, by digest; jobs that are given up."""

    tasks: tuple[Task, ...]
    joined: Mapping[str, frozenset[str]]
    given_up: frozenset[str]


def is_work_there(connection: Connection) -> bool:
    """Whether `claim` may find something."""
    query = select(jobs.c.id).where(or_(jobs.c.state == "waiting", _abandoned())).limit(1)
    return connection.execute(query).first() is not None


def claim(
    connection: Connection,
    by: str,
    lease_seconds: float,
    slots: int,
    at_work: Mapping[str, bool],
    most_attempts: int,
    lost: str,
) -> Claimed:
    """Take up jobs for the service ``by``: at most ``slots`` digests, the oldest first.

    Those that ask what it is ``at_work`` on (digests, and whether that takes more) join in. Jobs
    whose lease ran out go back into the line, or fail with the problem ``lost`` after so many
    attempts.
    """
    one_at_a_time(connection)
    ours = (jobs.c.leased_by == by) & jobs.c.digest.in_(tuple(at_work))
    given_up = _take_back(connection, _abandoned() & ~ours, most_attempts, lost)
    until = now() + round(1000 * lease_seconds)
    joined = {
        digest: found
        for digest, takes_more in at_work.items()
        if takes_more and (found := _start(connection, by, until, digest, attempts=0))
    }
    tasks: list[Task] = []
    while len(tasks) < slots and (task := _next(connection, by, until)) is not None:
        tasks.append(task)
    return Claimed(tuple(tasks), joined, given_up)


def pulse(
    connection: Connection,
    by: str,
    lease_seconds: float,
    shares: Mapping[str, tuple[str | None, float, int]],
) -> dict[str, frozenset[str]]:
    """Renew leases by digest, and note stage, share and attempts of each.

    Gives the jobs that the service still works on; what is missing was cancelled, or taken up by
    another.
    """
    until = now() + round(1000 * lease_seconds)
    left = {}
    for digest, (stage, share, attempts) in sorted(shares.items()):
        rows = connection.execute(
            update(jobs)
            .where(_held(by, digest))
            .values(stage=stage, share=share, attempts=attempts, leased_until=until)
            .returning(jobs.c.id)
        )
        left[digest] = frozenset(row.id for row in rows)
    return left


def finish(
    connection: Connection,
    by: str,
    digest: str,
    *,
    result: str | None = None,
    problem: str | None = None,
) -> frozenset[str]:
    """End all jobs that ask the same: with the key of a ``result``, or with a ``problem``.

    Nothing where the service does not hold the lease any more.
    """
    end = {
        "state": "failed" if result is None else "done",
        "problem": problem,
        "result": result,
        "finished_at": now(),
        "leased_by": None,
        "leased_until": None,
        **({} if result is None else {"share": 1.0}),
    }
    ended = _end(connection, _held(by, digest), end)
    if ended and result is not None:
        ended |= _end(connection, (jobs.c.digest == digest) & (jobs.c.state == "waiting"), end)
    return ended


def release(connection: Connection, by: str, only: Iterable[str] | None = None) -> None:
    """Put back what the service ``by`` works on, or ``only`` these jobs; this attempt was none."""
    which = (jobs.c.state == "running") & (jobs.c.leased_by == by)
    if only is not None:
        which &= jobs.c.id.in_(tuple(only))
    connection.execute(
        update(jobs)
        .where(which)
        .values(
            state="waiting",
            leased_by=None,
            leased_until=None,
            attempts=case((jobs.c.attempts > 0, jobs.c.attempts - 1), else_=0),
        )
    )


def _abandoned() -> ColumnElement[bool]:
    return (jobs.c.state == "running") & (jobs.c.leased_until < now())


def _held(by: str, digest: str) -> ColumnElement[bool]:
    return (jobs.c.digest == digest) & (jobs.c.state == "running") & (jobs.c.leased_by == by)


def _take_back(
    connection: Connection, which: ColumnElement[bool], most_attempts: int, lost: str
) -> frozenset[str]:
    """Put jobs whose worker is gone back into the line, or end them: these are given back."""
    free: dict[str, Any] = {"leased_by": None, "leased_until": None}
    end = {"state": "failed", "problem": lost, "finished_at": now(), **free}
    given_up = _end(connection, which & (jobs.c.attempts >= most_attempts), end)
    connection.execute(update(jobs).where(which).values(state="waiting", **free))
    return given_up


def _next(connection: Connection, by: str, until: int) -> Task | None:
    """The oldest job that nobody works on, with all that ask the same; it is ours now."""
    others = select(jobs.c.digest).where(jobs.c.state == "running")
    row = connection.execute(
        select(
            jobs.c.digest,
            jobs.c.attempts,
            jobs.c.document,
            jobs.c.layout,
            jobs.c.options,
            jobs.c.deadline_seconds,
        )
        .where(jobs.c.state == "waiting", jobs.c.digest.not_in(others))
        .order_by(jobs.c.created_at, jobs.c.id)
        .limit(1)
    ).first()
    if row is None:
        return None
    attempts = row.attempts + 1
    return Task(
        row.digest,
        _start(connection, by, until, row.digest, attempts),
        attempts,
        deflater.inflate(row.document),
        None if row.layout is None else deflater.inflate(row.layout),
        OPTIONS.validate_json(row.options),
        row.deadline_seconds,
    )


def _start(
    connection: Connection, by: str, until: int, digest: str, attempts: int
) -> frozenset[str]:
    rows = connection.execute(
        update(jobs)
        .where(jobs.c.digest == digest, jobs.c.state == "waiting")
        .values(
            state="running",
            leased_by=by,
            leased_until=until,
            attempts=attempts,
            started_at=func.coalesce(jobs.c.started_at, now()),
        )
        .returning(jobs.c.id)
    )
    return frozenset(row.id for row in rows)


def _end(
    connection: Connection, which: ColumnElement[bool], end: Mapping[str, Any]
) -> frozenset[str]:
    rows = connection.execute(update(jobs).where(which).values(end).returning(jobs.c.id))
    return frozenset(row.id for row in rows)
