"""Stored programs and their revisions. The functions want a connection of `app.store.database`.

Every change is a new revision whose number is one higher, undoing and redoing too. A revision
knows which one's content an undo of it restores (``undo_to``), and which one's a redo
(``redo_to``). An edit that amends the one before has the same ``undo_to``: then nothing leads to
the one before, and it goes sooner than others.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Connection, Row, Select, delete, exists, func, insert, select, update
from sqlalchemy.exc import IntegrityError

from app.answers import Revised
from app.errors import Outdated
from app.program.changes import Changes
from app.store.deflating import deflater
from app.store.records import Cause, Content, Head, Listed, Record
from app.store.tables import programs, revisions

_LONGEST_NAME = 500

_AT_A_TIME = 500
"""Names in one query."""

_RECORD: tuple[Any, ...] = (
    revisions.c.program,
    revisions.c.number,
    revisions.c.cause,
    revisions.c.name,
    revisions.c["items"],
    revisions.c.hyperedges,
    revisions.c.digest,
    revisions.c.changes,
    revisions.c.undo_to,
    revisions.c.redo_to,
    revisions.c.created_at,
    revisions.c.stopped_by,
)


def head(connection: Connection, program: str) -> Head | None:
    """Where a program is, if there ever was one of that id."""
    row = connection.execute(
        select(programs.c.revision, programs.c.deleted_at).where(programs.c.id == program)
    ).one_or_none()
    return None if row is None else Head(row.revision, row.deleted_at is not None)


def newest(connection: Connection, program: str) -> Record | None:
    """The newest revision of a program, if there is one and it is not deleted."""
    row = connection.execute(_newest(program, *_RECORD)).one_or_none()
    return None if row is None else _record(row)


def load(connection: Connection, program: str, number: int | None = None) -> Content | None:
    """A revision (``None``: the newest) with its content, if it is kept."""
    columns = (*_RECORD, revisions.c.document, revisions.c.layout)
    query = _newest(program, *columns)
    if number is not None:
        query = select(*columns).where(
            revisions.c.program == program,
            revisions.c.number == number,
            revisions.c.cause != "delete",
        )
    row = connection.execute(query).one_or_none()
    if row is None:
        return None
    return Content(_record(row), deflater.inflate(row.document), deflater.inflate(row.layout))


def kept_after(connection: Connection, program: str, number: int) -> list[Record]:
    """The revisions that are kept with a higher number, the oldest first."""
    rows = connection.execute(
        select(*_RECORD)
        .where(revisions.c.program == program, revisions.c.number > number)
        .order_by(revisions.c.number)
    )
    return [_record(row) for row in rows]


def listing(connection: Connection, after: str | None, limit: int) -> list[Listed]:
    """At most ``limit`` programs in the order of their ids, from the first that follows."""
    query = (
        select(
            programs.c.id,
            programs.c.revision,
            revisions.c.name,
            revisions.c["items"],
            revisions.c.hyperedges,
            programs.c.created_at,
            programs.c.updated_at,
        )
        .join(
            revisions,
            (revisions.c.program == programs.c.id) & (revisions.c.number == programs.c.revision),
        )
        .where(programs.c.deleted_at.is_(None))
        .order_by(programs.c.id)
        .limit(limit)
    )
    if after is not None:
        query = query.where(programs.c.id > after)
    return [Listed(*row) for row in connection.execute(query)]


def heads(connection: Connection, names: Sequence[str]) -> dict[str, int]:
    """The newest revisions' numbers of these programs, be they deleted or not."""
    found: dict[str, int] = {}
    for begin in range(0, len(names), _AT_A_TIME):
        part = names[begin : begin + _AT_A_TIME]
        rows = connection.execute(
            select(programs.c.id, programs.c.revision).where(programs.c.id.in_(part))
        )
        found.update((row.id, row.revision) for row in rows)
    return found


def add(
    connection: Connection,
    program: str,
    before: Head | None,
    cause: Cause,
    revised: Revised,
    *,
    undo_to: int | None = None,
    redo_to: int | None = None,
    keep: int,
    at: int,
) -> Record:
    """Make ``revised`` the revision after ``before``, and ``keep`` so many in all.

    Of those that were amended a quarter as many are kept, for whoever follows what happens.

    ``at`` is the time of the change: where it is tried again because nobody knows whether it was
    done, it is found out. Raises `Outdated` where somebody else made one meanwhile.
    """
    number = 1 if before is None else before.revision + 1
    own = connection.execute(
        select(*_RECORD).where(
            revisions.c.program == program,
            revisions.c.number == number,
            revisions.c.digest == revised.digest,
            revisions.c.created_at == at,
        )
    ).one_or_none()
    if own is not None:
        return _record(own)
    _step(connection, program, before, at, deleted=False)
    record = Record(
        program,
        number,
        cause,
        revised.name,
        revised.items,
        revised.hyperedges,
        revised.digest,
        revised.changes,
        undo_to,
        redo_to,
        at,
        None if revised.complete else "deadline",
    )
    _insert(connection, record, revised.document, revised.layout)
    _forget(connection, program, number, keep)
    return record


def end(connection: Connection, program: str, before: Head, at: int) -> Record:
    """Delete a program with all its content; what stays is its number, and that it was deleted.

    Raises `Outdated` where somebody changed it meanwhile.
    """
    _step(connection, program, before, at, deleted=True)
    connection.execute(delete(revisions).where(revisions.c.program == program))
    record = Record(
        program,
        before.revision + 1,
        "delete",
        None,
        0,
        0,
        "",
        Changes(whole=True),
        None,
        None,
        at,
    )
    _insert(connection, record, b"", b"")
    return record


def count(connection: Connection) -> int:
    """How many programs there are."""
    query = select(func.count()).select_from(programs).where(programs.c.deleted_at.is_(None))
    return int(connection.execute(query).scalar_one())


def _step(
    connection: Connection, program: str, before: Head | None, at: int, *, deleted: bool
) -> None:
    """Move the head from ``before`` to the next number, unless it is elsewhere by now."""
    if before is None:
        row = {"id": program, "revision": 1, "created_at": at, "updated_at": at}
        try:
            with connection.begin_nested():
                connection.execute(insert(programs).values(row))
        except IntegrityError:
            raise Outdated("The program was made by somebody else meanwhile.") from None
        return
    values: dict[str, Any] = {
        "revision": before.revision + 1,
        "updated_at": at,
        "deleted_at": at if deleted else None,
    }
    if before.is_deleted:
        values["created_at"] = at
    done = connection.execute(
        update(programs)
        .where(programs.c.id == program, programs.c.revision == before.revision)
        .values(values)
    )
    if done.rowcount == 0:
        raise Outdated("The program was changed by somebody else meanwhile.")


def _forget(connection: Connection, program: str, newest: int, keep: int) -> None:
    """Delete the revisions that are too many."""
    late = newest - max(1, keep // 4)
    own = revisions.alias()
    kept = select(own.c.number).where(own.c.program == program)
    oldest = kept.order_by(own.c.number.desc()).offset(keep - 1).limit(1).scalar_subquery()
    amends = (own.c.number == late + 1) & (own.c.cause == "edit") & (own.c.undo_to < late)
    is_amended = (revisions.c.number == late) & exists(kept.where(amends))
    connection.execute(
        delete(revisions).where(
            revisions.c.program == program, (revisions.c.number < oldest) | is_amended
        )
    )


def _insert(connection: Connection, record: Record, document: bytes, layout: bytes) -> None:
    connection.execute(
        insert(revisions).values(
            program=record.program,
            number=record.number,
            cause=record.cause,
            name=_storable(record.name),
            items=record.items,
            hyperedges=record.hyperedges,
            digest=record.digest,
            document=deflater.deflate(document),
            layout=deflater.deflate(layout),
            changes=record.changes.to_json(),
            undo_to=record.undo_to,
            redo_to=record.redo_to,
            created_at=record.created_at,
            stopped_by=record.stopped_by,
        )
    )


def _storable(name: str | None) -> str | None:
    """A name as every database can keep it: PostgreSQL has no character 0."""
    return None if name is None else name.replace("\0", "\N{REPLACEMENT CHARACTER}")[:_LONGEST_NAME]


def _newest(program: str, *columns: Any) -> Select[Any]:
    return (
        select(*columns)
        .join(
            programs,
            (revisions.c.program == programs.c.id) & (revisions.c.number == programs.c.revision),
        )
        .where(programs.c.id == program, programs.c.deleted_at.is_(None))
    )


def _record(row: Row[Any]) -> Record:
    return Record(
        row.program,
        row.number,
        row.cause,
        row.name,
        row.items,
        row.hyperedges,
        row.digest,
        Changes.from_json(row.changes),
        row.undo_to,
        row.redo_to,
        row.created_at,
        row.stopped_by,
    )
