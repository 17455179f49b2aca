"""Jobs, as whoever asked for them sees them; `app.store.leases` is for those who do them.

The functions want a connection of `app.store.database`.
"""

from __future__ import annotations

import secrets
import time
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from pydantic import TypeAdapter
from sqlalchemy import Connection, Row, delete, func, insert, select, text, update

from app.answers import RenderOptions
from app.errors import Overloaded
from app.store.deflating import deflater
from app.store.tables import jobs

State: TypeAlias = Literal["waiting", "running", "done", "failed", "cancelled"]

OVER: frozenset[State] = frozenset({"done", "failed", "cancelled"})
"""States in which nothing more happens to a job."""

LOCK = 7_118_253
"""Of PostgreSQL, so that services choose their jobs one after another."""

OPTIONS = TypeAdapter(RenderOptions)
"""Options as JSON, and back."""


@dataclass(frozen=True, slots=True)
class NewJob:
    """What is asked: a document, what of it, by whom. ``digest`` is the same for the same."""

    id: str
    digest: str
    owner: str | None
    document: bytes
    layout: bytes | None
    options: RenderOptions
    deadline_seconds: float


@dataclass(frozen=True, slots=True)
class Job:
    """How a job is. Times are milliseconds since 1970; ``problem`` is JSON."""

    id: str
    state: State
    digest: str
    owner: str | None
    options: RenderOptions
    created_at: int
    started_at: int | None = None
    finished_at: int | None = None
    attempts: int = 0
    stage: str | None = None
    share: float = 0.0
    problem: str | None = None
    result: str | None = None

    @property
    def is_over(self) -> bool:
        """Whether nothing more happens to it."""
        return self.state in OVER


_STATE: tuple[Any, ...] = (
    jobs.c.id,
    jobs.c.state,
    jobs.c.digest,
    jobs.c.owner,
    jobs.c.options,
    jobs.c.attempts,
    jobs.c.stage,
    jobs.c.share,
    jobs.c.problem,
    jobs.c.result,
    jobs.c.created_at,
    jobs.c.started_at,
    jobs.c.finished_at,
)


def new_id() -> str:
    """A name that nobody guesses; later ones come later in order."""
    return f"{now():012x}{secrets.token_hex(10)}"


def create(connection: Connection, job: NewJob, most_waiting: int) -> Job:
    """Put a job in line. Raises `Overloaded` where ``most_waiting`` are there already."""
    one_at_a_time(connection)
    if (found := find(connection, job.id)) is not None:  # the first attempt was done after all
        return found
    waiting = select(func.count()).select_from(jobs).where(jobs.c.state == "waiting")
    if connection.execute(waiting).scalar_one() >= most_waiting:
        raise Overloaded("Too many jobs are waiting already; try again later.")
    created_at = now()
    connection.execute(
        insert(jobs).values(
            id=job.id,
            state="waiting",
            digest=job.digest,
            owner=job.owner,
            document=deflater.deflate(job.document),
            layout=None if job.layout is None else deflater.deflate(job.layout),
            options=OPTIONS.dump_json(job.options).decode(),
            deadline_seconds=job.deadline_seconds,
            created_at=created_at,
        )
    )
    return Job(job.id, "waiting", job.digest, job.owner, job.options, created_at=created_at)


def find(connection: Connection, job: str) -> Job | None:
    """The job of this id."""
    row = connection.execute(select(*_STATE).where(jobs.c.id == job)).one_or_none()
    return None if row is None else _job(row)


def listing(connection: Connection, owner: str | None, before: str | None, limit: int) -> list[Job]:
    """At most ``limit`` jobs, the newest first; of one owner, or (``None``) of all.

    ``before`` is the last one of the page before.
    """
    query = select(*_STATE).order_by(jobs.c.id.desc()).limit(limit)
    if owner is not None:
        query = query.where(jobs.c.owner == owner)
    if before is not None:
        query = query.where(jobs.c.id < before)
    return [_job(row) for row in connection.execute(query)]


def counts(connection: Connection) -> dict[str, int]:
    """How many jobs wait, and how many are worked on, in all services together."""
    states = ("waiting", "running")
    query = (
        select(jobs.c.state, func.count()).where(jobs.c.state.in_(states)).group_by(jobs.c.state)
    )
    found: dict[str, int] = dict(connection.execute(query).tuples().all())
    return {state: found.get(state, 0) for state in states}


def cancel(connection: Connection, job: str) -> bool:
    """End a job whose result nobody wants. False where it was over before."""
    done = connection.execute(
        update(jobs)
        .where(jobs.c.id == job, jobs.c.state.in_(("waiting", "running")))
        .values(state="cancelled", finished_at=now(), leased_by=None, leased_until=None)
    )
    return done.rowcount > 0


def forget(connection: Connection, before: int) -> int:
    """Delete jobs that were over before that time (ms since 1970); how many there were."""
    old = jobs.c.state.in_(tuple(OVER)) & (jobs.c.finished_at < before)
    return connection.execute(delete(jobs).where(old)).rowcount


def one_at_a_time(connection: Connection) -> None:
    """Let nobody else choose jobs, or add one, until this transaction ends."""
    if connection.dialect.name == "postgresql":
        connection.execute(text("SELECT pg_advisory_xact_lock(:lock)"), {"lock": LOCK})


def _job(row: Row[Any]) -> Job:
    found = row._asdict()
    return Job(**{**found, "options": OPTIONS.validate_json(row.options)})


def now() -> int:
    """Milliseconds since 1970."""
    return time.time_ns() // 1_000_000
