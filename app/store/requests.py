"""Answers to requests that may be sent twice, so that they are done once (Idempotency-Key)."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import Connection, delete, insert, select
from sqlalchemy.exc import IntegrityError

from app.errors import Outdated
from app.store.tables import requests

KEPT_MILLISECONDS = 24 * 3600 * 1000


@dataclass(frozen=True, slots=True)
class Reply:
    """What was answered, and a digest of what had been asked."""

    fingerprint: str
    status: int
    headers: Mapping[str, str]
    body: bytes


def find(connection: Connection, request: str) -> Reply | None:
    """What ``request`` was answered before, if it was."""
    row = connection.execute(select(requests).where(requests.c.id == request)).one_or_none()
    if row is None or row.created_at < _now() - KEPT_MILLISECONDS:
        return None
    return Reply(row.fingerprint, row.status, json.loads(row.headers), row.body)


def keep(connection: Connection, request: str, reply: Reply) -> None:
    """Remember an answer. Raises `Outdated` where the same request was answered meanwhile."""
    now = _now()
    connection.execute(delete(requests).where(requests.c.created_at < now - KEPT_MILLISECONDS))
    try:
        with connection.begin_nested():
            connection.execute(
                insert(requests).values(
                    id=request,
                    fingerprint=reply.fingerprint,
                    status=reply.status,
                    headers=json.dumps(dict(reply.headers)),
                    body=reply.body,
                    created_at=now,
                )
            )
    except IntegrityError:
        raise Outdated("The same request was answered meanwhile.") from None


def _now() -> int:
    return time.time_ns() // 1_000_000
