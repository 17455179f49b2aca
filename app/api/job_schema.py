"""What FastAPI cannot know of the calls for jobs, as arguments of their routes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from app.api.job_model import JobModel
from app.api.schema import contents, documents, headers, problem

_CALL = "render"
"""Whose query starts a job: problems may be pictures there too."""

_MISSING: Mapping[int, str] = {
    400: "The id, or a parameter, does not follow its schema.",
    404: "There is no such job (any more), or it is another key's.",
    503: "The database does not answer.",
}

_WRONG_START: Mapping[int, str] = {
    400: "A parameter does not follow its schema.",
    404: "There is no such program or revision (any more).",
    408: "The body did not come in time.",
    413: "The body has too many bytes.",
    415: "The body is not plain JSON.",
    422: "The query contradicts itself, or the key was used for another request.",
    429: "Too much was asked lately; `Retry-After` says when to try again.",
    503: "Too many jobs are waiting, or the database does not answer.",
}

_FAILED: Mapping[int, str] = {
    409: "The job is not done, or was cancelled.",
    410: "The result is not kept any more.",
    413: "The job failed: something exceeds a limit.",
    422: "The job failed: the document contradicts itself, say.",
    500: "The job failed: worker processes died over it.",
    504: "The job failed: it took too long.",
}

_IDEMPOTENCY = {
    "name": "Idempotency-Key",
    "in": "header",
    "required": False,
    "schema": {"type": "string"},
    "description": "Anything; the same again gets the same job, for a day.",
}

_PREFER = {
    "name": "Prefer",
    "in": "header",
    "required": False,
    "schema": {"type": "string"},
    "example": "respond-async, wait=10",
    "description": "`respond-async`: rather a job than to wait for long; `wait`: seconds.",
}

JOB_STARTED: Mapping[str, Any] = {
    "description": "The job is in line; `Location` says where it is.",
    "headers": headers("Location", "Retry-After", "Preference-Applied"),
    "model": JobModel,
}
"""The answer that tells of a new job."""


def or_job(described: dict[str, Any]) -> dict[str, Any]:
    """The description of a call that may start a job instead of answering."""
    extra = described["openapi_extra"]
    return {
        **described,
        "responses": {**described["responses"], 202: JOB_STARTED},
        "openapi_extra": {**extra, "parameters": [*extra.get("parameters", ()), _PREFER]},
    }


def describe_start() -> dict[str, Any]:
    """Of the call that starts a job."""
    return {
        "status_code": 202,
        "response_model": None,
        "responses": {202: JOB_STARTED, **_problems(_WRONG_START)},
        "openapi_extra": {
            "parameters": [_IDEMPOTENCY],
            "requestBody": {"required": False, "content": documents()},
        },
    }


def describe_list() -> dict[str, Any]:
    """Of the list of jobs."""
    wrong = {400: "A parameter does not follow its schema.", 503: _MISSING[503]}
    return {"responses": _problems(wrong)}


def describe_state() -> dict[str, Any]:
    """Of the call that says how a job is."""
    return {"responses": _problems(_MISSING)}


def describe_cancel() -> dict[str, Any]:
    """Of the call that ends a job."""
    return {
        "status_code": 204,
        "response_model": None,
        "responses": {204: {"description": "The job is over."}, **_problems(_MISSING)},
    }


def describe_events() -> dict[str, Any]:
    """Of the call that watches a job."""
    content = {"text/event-stream": {"schema": {"type": "string"}}}
    told = {"description": "Events, until the job is over.", "content": content}
    return {"response_model": None, "responses": {200: told, **_problems(_MISSING)}}


def describe_result() -> dict[str, Any]:
    """Of the call that fetches what a job has made."""
    done = {
        "description": "What the job has made.",
        "headers": headers("ETag", "Vary", "Content-Disposition", "Tubeloom-Stopped-By"),
        "content": contents("render"),
    }
    unchanged = {
        "description": "The client has this answer already (`If-None-Match`).",
        "headers": headers("ETag", "Vary"),
    }
    wrong = _problems({**_MISSING, **_FAILED})
    return {"response_model": None, "responses": {200: done, 304: unchanged, **wrong}}


def _problems(wrong: Mapping[int, str]) -> dict[int | str, Any]:
    return {status: problem(_CALL, detail) for status, detail in wrong.items()}
