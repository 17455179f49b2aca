"""What a client would like but does not insist on: the header ``Prefer`` (RFC 7240)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from urllib.request import parse_http_list

MOST_DIGITS = 9
"""Of seconds that a client would wait: some thirty years."""


@dataclass(frozen=True, slots=True)
class Preferences:
    """Whether the client would rather not wait, and how many seconds it would."""

    respond_async: bool = False
    wait: float | None = None

    @property
    def applied(self) -> str:
        """What stands in ``Preference-Applied`` where the client does not have to wait."""
        return "respond-async" if self.wait is None else f"respond-async, wait={self.wait:g}"


def preferences(headers: Iterable[str]) -> Preferences:
    """Of all ``Prefer`` headers of a request; of a preference given twice the first counts.

    >>> preferences(['respond-async; foo="a,b", wait=10', "wait=20"])
    Preferences(respond_async=True, wait=10.0)
    """
    found: dict[str, str] = {}
    for header in headers:
        for preference in parse_http_list(header):
            name, _, value = preference.partition(";")[0].partition("=")
            found.setdefault(name.strip().lower(), value.strip().strip('"'))
    wait = found.get("wait", "")
    is_whole = wait.isdecimal() and len(wait) <= MOST_DIGITS
    return Preferences("respond-async" in found, float(wait) if is_whole else None)
