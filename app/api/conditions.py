"""Validators: which answers a client has already (RFC 9110, 13.1.2)."""

from __future__ import annotations

import re

from app.answers import ANYTHING

_TAG = re.compile(r'(?:W/)?"([\x21\x23-\x7e\x80-\xff]*)"')


def known_tags(if_none_match: str | None) -> frozenset[str]:
    """The tags of an ``If-None-Match`` header, compared weakly: ``W/`` does not count.

    >>> sorted(known_tags('"a", W/"b"'))
    ['a', 'b']
    """
    if if_none_match is None:
        return frozenset()
    if if_none_match.strip() == ANYTHING:
        return frozenset({ANYTHING})
    return frozenset(_TAG.findall(if_none_match)) - {ANYTHING}


def entity_tag(tag: str) -> str:
    """A strong ``ETag``.

    >>> entity_tag("a")
    '"a"'
    """
    return f'"{tag}"'
