"""The rows of results: written many at a time, and deleted where there is too much."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from sqlalchemy import Connection, bindparam, case, delete, func, select, update
from sqlalchemy.dialects import postgresql, sqlite

from app.store.tables import results

Gone: TypeAlias = list[tuple[str, str]]
"""Keys and digests of rows that are no more: their objects can go."""


def digest_in(notes: str) -> str:
    """The digest of a result's bytes, which its notes tell."""
    return str(json.loads(notes)["digest"])


def note(
    connection: Connection,
    rows: Sequence[Mapping[str, Any]],
    used: Mapping[str, int],
    limit: int | None,
    now: int,
) -> Gone:
    """Write ``rows``, and when others were ``used``; then keep all of them within ``limit`` bytes.

    Times are milliseconds since 1970. What is kept until later than ``now`` stays in any case.
    """
    gone: Gone = []
    for row in rows:
        gone += _write(connection, row)
    if used:
        connection.execute(
            update(results).where(results.c.key == bindparam("of")).values(used_at=bindparam("at")),
            [{"of": key, "at": at} for key, at in used.items()],
        )
    if limit is not None:
        gone += _evict(connection, limit, now)
    return gone


def _write(connection: Connection, row: Mapping[str, Any]) -> Gone:
    """Write a row, in place of the one that there was."""
    before = connection.execute(
        select(results.c.key, results.c.notes).where(results.c.key == row["key"])
    ).one_or_none()
    insert = postgresql.insert if connection.dialect.name == "postgresql" else sqlite.insert
    new = insert(results).values(**row)
    kept_until = case(
        (results.c.kept_until > new.excluded.kept_until, results.c.kept_until),
        else_=new.excluded.kept_until,
    )
    others = {name: new.excluded[name] for name in row if name not in {"key", "kept_until"}}
    connection.execute(
        new.on_conflict_do_update(index_elements=["key"], set_={**others, "kept_until": kept_until})
    )
    if before is None or digest_in(before.notes) == digest_in(row["notes"]):
        return []
    return [(before.key, digest_in(before.notes))]


def _evict(connection: Connection, limit: int, now: int) -> Gone:
    """Delete the rows that were used the longest ago, until the others fit."""
    total = connection.execute(select(func.coalesce(func.sum(results.c.size), 0))).scalar_one()
    gone: Gone = []
    if total <= limit:
        return gone
    oldest = connection.execute(
        select(results.c.key, results.c.notes, results.c.size)
        .where(results.c.kept_until < now)
        .order_by(results.c.used_at, results.c.key)
    )
    for row in oldest:
        if total <= limit:
            break
        gone.append((row.key, digest_in(row.notes)))
        total -= row.size
    oldest.close()
    for key, _ in gone:
        connection.execute(delete(results).where(results.c.key == key))
    return gone
