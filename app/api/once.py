"""Requests that are done once, however often they are sent (``Idempotency-Key``)."""

from __future__ import annotations

import hashlib

from starlette.requests import Request

from app.api.guard import key_of
from app.api.problems import ReusedKeyError
from app.store.requests import Reply

HEADER = "Idempotency-Key"

MOST_CHARACTERS = 255


def request_of(request: Request) -> str | None:
    """Names a request that says that it is the same when it is sent again; else ``None``.

    Raises `ReusedKeyError` for a key that is too long.
    """
    given = request.headers.get(HEADER)
    if not given:
        return None
    if len(given) > MOST_CHARACTERS:
        raise ReusedKeyError(f"An {HEADER} has at most {MOST_CHARACTERS} characters.")
    asked = (key_of(request) or "", request.method, request.url.path, given)
    return _digest("\n".join(asked).encode())


def fingerprint_of(request: Request, body: bytes) -> str:
    """What two requests of one key must have in common."""
    headers = (request.headers.get(name, "") for name in ("content-type", "if-match"))
    return _digest("\n".join([request.url.query, *headers]).encode() + b"\n" + body)


def check_is_same(reply: Reply, fingerprint: str) -> None:
    """Raise `ReusedKeyError` where ``reply`` was the answer to something else."""
    if reply.fingerprint != fingerprint:
        raise ReusedKeyError(f"This {HEADER} was used for another request.")


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
