"""Names of other people's things as ids and labels: shortened, and still told apart."""

from __future__ import annotations

from hashlib import sha256

LONGEST_LABEL = 40
LONGEST_NAME = 140
"""Letters of a name that go into an id."""


def short(text: str, length: int = LONGEST_LABEL) -> str:
    """The beginning of a text.

    >>> short("a rather long name", 9)
    'a rather…'
    """
    return text if len(text) <= length else f"{text[: length - 1]}…"


def distinct(name: str) -> str:
    """A name that is short enough for an id, and still no other's."""
    if len(name) <= LONGEST_NAME:
        return name
    return f"{name[:LONGEST_NAME]}…{sha256(name.encode()).hexdigest()[:16]}"


def untaken(name: str, taken: set[str]) -> str:
    """``name`` as an id that is not among those ``taken``, and is from now on.

    >>> taken: set[str] = set()
    >>> untaken("a", taken), untaken("a", taken), untaken("", taken)
    ('a', "a'", "'")
    """
    found = distinct(name) or "'"
    while found in taken:
        found += "'"
    taken.add(found)
    return found
