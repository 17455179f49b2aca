"""What can go wrong, as exceptions.

TubeloomError
├── Unreachable      no answer: nobody listens, or the connection broke
├── JobCancelled     somebody cancelled the job that was waited for
└── Problem          the service refused, and says why (RFC 9457)
    ├── NotAllowed   no key, or one without the scope that the call needs
    ├── NotFound     there is no such program, revision or job
    ├── LostRace     somebody else has changed the program meanwhile
    ├── Busy         too many requests, or too much work
    └── JobFailed    the job's work failed
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import httpx

MEDIA_TYPE = "application/problem+json"


class TubeloomError(Exception):
    """Any of these errors."""


class Unreachable(TubeloomError):
    """There was no answer, however often it was tried."""


class JobCancelled(TubeloomError):
    """The job that was waited for has been cancelled."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is wrong: where, by JSON pointer or parameter, and what would be right."""

    detail: str
    pointer: str | None = None
    parameter: str | None = None


class Problem(TubeloomError):
    """The service's own words about what is wrong."""

    def __init__(self, details: Mapping[str, Any], retry_after: float | None = None) -> None:
        self.status = int(details.get("status", 0))
        self.type = str(details.get("type", "about:blank"))
        self.title = str(details.get("title", ""))
        self.detail = str(details.get("detail", ""))
        self.errors = tuple(
            Fault(fault.get("detail", ""), fault.get("pointer"), fault.get("parameter"))
            for fault in details.get("errors", ())
        )
        self.retry_after = retry_after
        super().__init__(f"{self.status} {self.title} {self.detail}".strip())

    @property
    def name(self) -> str:
        """The stable name of the kind of problem, such as ``inconsistent-document``."""
        return self.type.rpartition(":")[2]


class NotAllowed(Problem):
    """There is no valid key, or it lacks the scope that the call needs."""


class NotFound(Problem):
    """There is no such program, revision or job, or not any more."""


class LostRace(Problem):
    """The program is not as it was when it was last seen here: get it, and try again."""


class Busy(Problem):
    """Too many requests, or too much work; ``retry_after`` says how many seconds to wait."""


class JobFailed(Problem):
    """The job's work failed."""


_BY_STATUS: Mapping[int, type[Problem]] = {
    401: NotAllowed,
    403: NotAllowed,
    404: NotFound,
    410: NotFound,
    412: LostRace,
    429: Busy,
    503: Busy,
}


def problem_of(response: httpx.Response) -> Problem:
    """What a response that is not a success says, even if it comes from something in between."""
    details: Any = None
    if response.headers.get("content-type", "").startswith(MEDIA_TYPE):
        details = response.json()
    if not isinstance(details, dict):
        details = {"title": response.reason_phrase}
    details = {"status": response.status_code, **details}
    kind = _BY_STATUS.get(response.status_code, Problem)
    return kind(details, retry_after_of(response))


def retry_after_of(response: httpx.Response) -> float | None:
    """The seconds that the response asks to wait, if it does."""
    try:
        return float(response.headers["retry-after"])
    except (KeyError, ValueError):
        return None
