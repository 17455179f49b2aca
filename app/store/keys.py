"""API keys. Only their digests are kept: whoever reads the database cannot use one.

The functions want a connection of `app.store.database`. A key is long and random, so that a plain
digest is as good as a slow one, and a thousand times as quick.
"""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, Row, insert, select, update

from app.store.tables import keys

PREFIX = "tl_"
"""Begins every key, so that people, and programs that look for leaked ones, know it."""

SECRET_BYTES = 32


@dataclass(frozen=True, slots=True)
class Key:
    """What is known of a key. Times are milliseconds since 1970."""

    id: str
    name: str
    scopes: frozenset[str]
    created_at: int
    used_at: int | None = None
    revoked_at: int | None = None


def digest_of(secret: str) -> str:
    """What is kept of a key."""
    return hashlib.sha256(secret.encode()).hexdigest()


def create(connection: Connection, name: str, scopes: Iterable[str]) -> tuple[Key, str]:
    """A new key, and its secret, which nobody can find again."""
    secret = PREFIX + secrets.token_urlsafe(SECRET_BYTES)
    key = Key(secrets.token_hex(4), name, frozenset(scopes), _now())
    connection.execute(
        insert(keys).values(
            id=key.id,
            hash=digest_of(secret),
            name=name,
            scopes=" ".join(sorted(key.scopes)),
            created_at=key.created_at,
        )
    )
    return key, secret


def find(connection: Connection, digest: str) -> Key | None:
    """The key with this digest, unless it is revoked."""
    row = connection.execute(
        select(keys).where(keys.c.hash == digest, keys.c.revoked_at.is_(None))
    ).one_or_none()
    return None if row is None else _key(row)


def all_keys(connection: Connection) -> list[Key]:
    """Every key that there ever was, the oldest first."""
    rows = connection.execute(select(keys).order_by(keys.c.created_at, keys.c.id))
    return [_key(row) for row in rows]


def revoke(connection: Connection, key_id: str) -> bool:
    """End a key. False where there is none such, or it has been revoked before."""
    done = connection.execute(
        update(keys)
        .where(keys.c.id == key_id, keys.c.revoked_at.is_(None))
        .values(revoked_at=_now())
    )
    return done.rowcount > 0


def note_use(connection: Connection, key_ids: Iterable[str]) -> None:
    """Remember that these keys were used just now."""
    connection.execute(update(keys).where(keys.c.id.in_(tuple(key_ids))).values(used_at=_now()))


def _key(row: Row[Any]) -> Key:
    return Key(
        row.id,
        row.name,
        frozenset(row.scopes.split()),
        row.created_at,
        row.used_at,
        row.revoked_at,
    )


def _now() -> int:
    return time.time_ns() // 1_000_000
