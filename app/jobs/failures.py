"""Why a job failed, as JSON that outlives the process, and back."""

from __future__ import annotations

import json

from app import errors
from app.errors import DocumentError, Fault, TubeloomError, UnknownName


class UnforeseenFailure(Exception):
    """A job failed in a way that nobody foresaw; the log said more when it happened."""


def failure_text(error: Exception) -> str:
    """The error as JSON.

    >>> failure_text(errors.DeadlineExceeded("Too long."))
    '{"error": "DeadlineExceeded", "detail": "Too long."}'
    """
    match error:
        case DocumentError(faults=faults):
            told = {"faults": [[fault.pointer, fault.detail] for fault in faults]}
            return json.dumps({"error": type(error).__name__, **told})
        case UnknownName(kind=kind, name=name, known=known):
            return json.dumps({"error": "UnknownName", "name": [kind, name, list(known)]})
        case TubeloomError():
            return json.dumps({"error": type(error).__name__, "detail": str(error)})
        case _:
            return json.dumps({"error": "UnforeseenFailure"})


def failure_of(text: str) -> Exception:
    """The error that `failure_text` wrote.

    >>> failure_of(failure_text(errors.DeadlineExceeded("Too long.")))
    DeadlineExceeded('Too long.')
    """
    told = json.loads(text)
    kind = getattr(errors, told["error"], UnforeseenFailure)
    if "faults" in told:
        error: Exception = kind(Fault(pointer, detail) for pointer, detail in told["faults"])
        return error
    if "name" in told:
        return UnknownName(*told["name"])
    found: Exception = kind(told.get("detail", ""))
    return found
