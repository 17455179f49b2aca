"""Errors as problem details (RFC 9457): the one place where an exception becomes HTTP.

400 says that a request does not follow the published schema; 422 that it follows it, but cannot
be carried out.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any

from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from app.errors import (
    LONGEST_KEY,
    DeadlineExceeded,
    DocumentError,
    DocumentTooLarge,
    ImpossibleSweep,
    InconsistentDocument,
    InvalidDocument,
    NothingToUndo,
    NotStored,
    Outdated,
    OutOfMemory,
    Overloaded,
    PatchConflict,
    PictureTooLarge,
    RendererUnavailable,
    StoreFull,
    StoreUnavailable,
    TubeloomError,
    UnknownName,
    Unprintable,
    UnreadableDocument,
    WorkerLost,
)
from app.program.faults import MOST_FAULTS

MEDIA_TYPE = "application/problem+json"

RETRY_AFTER_SECONDS = 2
"""Long enough for some of the line to be worked off, short enough for someone who watches."""


class RefusalError(Exception):
    """A request that HTTP alone is enough to refuse; ``headers`` say more of it."""

    headers: Mapping[str, str] | None = None


class NotAcceptableError(RefusalError):
    """Nothing that there is fits what the client accepts."""


class ContradictionError(RefusalError):
    """Query parameters that make no sense together."""


class UnsupportedMediaTypeError(RefusalError):
    """The body is not JSON, or is compressed."""


class BodyTooLargeError(RefusalError):
    """The body has more bytes than the settings allow."""


class SlowUploadError(RefusalError):
    """The body did not come in time."""


class NoKeyError(RefusalError):
    """A key is needed, and there is none, or it is not valid."""

    def __init__(self, detail: str, *, given: bool) -> None:
        super().__init__(detail)
        error = ', error="invalid_token"' if given else ""
        self.headers = {"WWW-Authenticate": f'Bearer realm="tubeloom"{error}'}


class WrongScopeError(RefusalError):
    """The key is valid, but not good for this."""

    def __init__(self, scope: str) -> None:
        super().__init__(f"This needs a key with the scope {scope}.")
        challenge = f'Bearer realm="tubeloom", error="insufficient_scope", scope="{scope}"'
        self.headers = {"WWW-Authenticate": challenge}


class PreconditionFailedError(RefusalError):
    """A stored program is not in the state that the request asks for."""


class PreconditionRequiredError(RefusalError):
    """The request must say which revision of a stored program it changes."""


class ReusedKeyError(RefusalError):
    """An ``Idempotency-Key`` that cannot be used, or was for another request."""


class PatchTypeError(RefusalError):
    """The body is no kind of patch that is known."""

    def __init__(self, detail: str) -> None:
        super().__init__(detail)
        self.headers = {"Accept-Patch": "application/json-patch+json, application/merge-patch+json"}


class JobNotDoneError(RefusalError):
    """What is asked of a job is only there when it is done."""


class ResultGoneError(RefusalError):
    """What a job had made is not kept any more."""


class TooManyRequestsError(RefusalError):
    """Whoever asks has asked for too much lately."""

    def __init__(self, detail: str, headers: Mapping[str, str]) -> None:
        super().__init__(detail)
        self.headers = headers


class WrongHostError(RefusalError):
    """The request names a host that this service is not."""


class LongQueryError(RefusalError):
    """The query has more parameters than are read."""


class ForeignPageError(RefusalError):
    """A page of another origin, which is not among those allowed, wants to change something."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of problem. ``name`` is the stable end of its ``type``."""

    status: int
    name: str
    title: str

    @property
    def type(self) -> str:
        """An identifier that stays the same, wherever the service runs."""
        return f"urn:tubeloom:problem:{self.name}"


KINDS: Mapping[type[Exception], Kind] = {
    UnreadableDocument: Kind(400, "unreadable-document", "The document is not JSON."),
    InvalidDocument: Kind(400, "invalid-document", "The document does not follow its schema."),
    InconsistentDocument: Kind(422, "inconsistent-document", "The document contradicts itself."),
    DocumentTooLarge: Kind(413, "document-too-large", "The document exceeds a limit."),
    Unprintable: Kind(422, "unprintable", "Something in the document cannot be printed."),
    ImpossibleSweep: Kind(422, "impossible-sweep", "The document has no such variations."),
    UnknownName: Kind(422, "unknown-name", "The document names something that does not exist."),
    PictureTooLarge: Kind(422, "picture-too-large", "The picture would have too many pixels."),
    OutOfMemory: Kind(413, "out-of-memory", "The work takes more memory than it may."),
    RendererUnavailable: Kind(503, "renderer-unavailable", "This machine cannot draw."),
    WorkerLost: Kind(500, "worker-lost", "The work ended a process, twice."),
    DeadlineExceeded: Kind(504, "deadline-exceeded", "The work took too long."),
    Overloaded: Kind(503, "overloaded", "The service is busy."),
    StoreUnavailable: Kind(503, "store-unavailable", "What is stored cannot be reached."),
    RequestValidationError: Kind(400, "invalid-parameter", "A query parameter is wrong."),
    NotAcceptableError: Kind(406, "not-acceptable", "No format fits what is accepted."),
    PatchConflict: Kind(409, "patch-conflict", "The patch does not fit the document."),
    NotStored: Kind(404, "not-stored", "There is no such thing."),
    Outdated: Kind(409, "outdated", "Somebody else was first."),
    NothingToUndo: Kind(409, "nothing-to-undo", "There is no such change."),
    StoreFull: Kind(507, "store-full", "No more programs are taken."),
    PreconditionFailedError: Kind(412, "precondition-failed", "Somebody else was first."),
    PreconditionRequiredError: Kind(428, "precondition-required", "Say what you change."),
    ReusedKeyError: Kind(422, "reused-key", "The key was used for another request."),
    PatchTypeError: Kind(415, "not-a-patch", "The body is no patch."),
    UnsupportedMediaTypeError: Kind(415, "unsupported-media-type", "The body is not plain JSON."),
    ContradictionError: Kind(422, "contradiction", "The query contradicts itself."),
    BodyTooLargeError: Kind(413, "body-too-large", "The body has too many bytes."),
    SlowUploadError: Kind(408, "slow-upload", "The body did not come in time."),
    NoKeyError: Kind(401, "no-key", "A valid key is needed."),
    WrongScopeError: Kind(403, "wrong-scope", "The key is not good for this."),
    ForeignPageError: Kind(403, "foreign-page", "Pages of this origin are not allowed."),
    LongQueryError: Kind(400, "long-query", "The query has too many parameters."),
    WrongHostError: Kind(421, "wrong-host", "This service does not answer for that host."),
    JobNotDoneError: Kind(409, "job-not-done", "The job has no result."),
    ResultGoneError: Kind(410, "result-gone", "The result is not kept any more."),
    TooManyRequestsError: Kind(429, "too-many-requests", "Too much was asked lately."),
}

UNEXPECTED = Kind(500, "unexpected-error", "Something went wrong that should not.")


def problem_response(request: Request, error: Exception) -> Response:
    """The problem that ``error`` is to a client, in JSON."""
    details = problem_of(request, error)
    body = json.dumps(details, ensure_ascii=False).encode()
    return Response(body, details["status"], headers_of(error), MEDIA_TYPE)


def problem_of(request: Request, error: Exception) -> dict[str, Any]:
    """What is wrong, for a client to read. Nothing of our insides shows in it."""
    kind = _kind_of(error)
    details: dict[str, Any] = {
        "type": kind.type,
        "title": kind.title,
        "status": kind.status,
        "detail": _detail(error),
    }
    if "request_id" in request.scope.get("state", {}):
        details["instance"] = f"urn:tubeloom:request:{request.state.request_id}"
    if errors := _errors(error):
        details["errors"] = errors
    return details


def _kind_of(error: Exception) -> Kind:
    if isinstance(error, HTTPException):
        phrase = HTTPStatus(error.status_code).phrase
        return Kind(error.status_code, phrase.lower().replace(" ", "-"), f"{phrase}.")
    return next((KINDS[cls] for cls in type(error).__mro__ if cls in KINDS), UNEXPECTED)


def _detail(error: Exception) -> str:
    match error:
        case DocumentError(faults=faults):
            more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
            first = faults[0]
            return (
                f"{first.pointer}: {first.detail}{more}" if first.pointer else first.detail + more
            )
        case RequestValidationError():
            return "; ".join(f"{fault['parameter']}: {fault['detail']}" for fault in _errors(error))
        case HTTPException():
            return error.detail
        case TubeloomError() | RefusalError():
            return str(error)
        case _:
            return "The service's log says more, under this request's id."


def _errors(error: Exception) -> Sequence[Mapping[str, str]]:
    match error:
        case DocumentError():
            return [{"pointer": fault.pointer, "detail": fault.detail} for fault in error.faults]
        case RequestValidationError():
            return [
                {
                    "parameter": _parameter(fault["loc"])[:LONGEST_KEY],
                    "detail": _parameter_detail(fault),
                }
                for fault in error.errors()[:MOST_FAULTS]
            ]
        case _:
            return []


def _parameter(place: Sequence[str | int]) -> str:
    """Its name: in a query the first part, behind which parts of its type may follow."""
    return str(place[1] if place[0] == "query" and len(place) > 1 else place[-1])


def _parameter_detail(fault: Mapping[str, Any]) -> str:
    if fault["type"] == "extra_forbidden":
        return "There is no such parameter."
    return f"{fault['msg']}."


def headers_of(error: Exception) -> Mapping[str, str] | None:
    """Headers that say more of a problem."""
    match error:
        case HTTPException() | RefusalError():
            return error.headers
        case Overloaded() | StoreUnavailable():
            return {"Retry-After": str(RETRY_AFTER_SECONDS)}
        case _:
            return None
