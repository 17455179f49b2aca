"""Which revision of a stored program a change is meant for (RFC 9110, 13.1)."""

from __future__ import annotations

import re
from collections.abc import Callable

from starlette.requests import Request

from app.answers import ANYTHING
from app.api.problems import PreconditionFailedError, PreconditionRequiredError
from app.api.revision_model import tag_of
from app.settings import Settings
from app.store.records import Record

_STRONG_TAG = re.compile(r'(?<![/\w])"([\x21\x23-\x7e\x80-\xff]*)"')


def strong_tags(if_match: str) -> frozenset[str]:
    """The tags of an ``If-Match`` header; weak ones never match.

    >>> sorted(strong_tags('"a", W/"b", "c"')), strong_tags("*")
    (['a', 'c'], frozenset({'*'}))
    """
    if if_match.strip() == ANYTHING:
        return frozenset({ANYTHING})
    return frozenset(_STRONG_TAG.findall(if_match)) - {ANYTHING}


def precondition(request: Request) -> Callable[[Record | None], None]:
    """What a request's ``If-Match`` and ``If-None-Match: *`` ask of the newest revision.

    What is returned raises `PreconditionFailedError`, and `PreconditionRequiredError` where the
    settings want an ``If-Match`` and there is none.
    """
    if_match = request.headers.get("if-match")
    only_new = (request.headers.get("if-none-match") or "").strip() == ANYTHING
    settings: Settings = request.app.state.settings
    tags = None if if_match is None else strong_tags(if_match)

    def check(newest: Record | None) -> None:
        if only_new and newest is not None:
            raise PreconditionFailedError("There is a program of this id already.")
        if tags is None:
            if settings.require_if_match and newest is not None and not only_new:
                raise PreconditionRequiredError(
                    "Say which revision you change: If-Match with the ETag that you got."
                )
            return
        if newest is None:
            raise PreconditionFailedError("There is no program of this id (any more).")
        if not tags & {ANYTHING, tag_of(newest)}:
            raise PreconditionFailedError(
                f"The newest revision is {newest.number}, not the one that you changed."
            )

    return check
