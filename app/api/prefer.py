"""What a client would like but does not insist on: the header ``Prefer`` (RFC 7240)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

_PREFERENCE = re.compile(
    r"\s*([!#$%&'*+.^_`|~0-9A-Za-z-]+)\s*(?:=\s*(\"(?:[^\"\\]|\\.)*\"|[^\s;,\"]*))?[^,]*(?:,|$)"
)


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
    for match in _PREFERENCE.finditer(", ".join(headers)):
        found.setdefault(match[1].lower(), (match[2] or "").strip('"'))
    wait = found.get("wait", "")
    return Preferences("respond-async" in found, float(wait) if wait.isdecimal() else None)
