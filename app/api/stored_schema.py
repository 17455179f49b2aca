"""What FastAPI cannot know of the calls for stored programs, as arguments of their routes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from app.api.schema import EXAMPLE, contents, documents, headers, problem, reference

JSON_PATCH = "application/json-patch+json"
MERGE_PATCH = "application/merge-patch+json"

_CALL = "stored"

_WRONG: Mapping[int, str] = {
    400: "A parameter, or the body, does not follow its schema.",
    404: "There is no such program or revision (any more).",
    503: "The service is busy, or its database does not answer.",
}

_WRONG_VIEW: Mapping[int, str] = {
    406: "No format fits what is accepted.",
    413: "The answer would exceed a limit.",
    422: "The query contradicts itself, or the program cannot be printed.",
    500: "A worker process died over the program, twice.",
    504: "The work took too long.",
}

_WRONG_CHANGE: Mapping[int, str] = {
    409: "The patch does not fit the document, or there is nothing to undo or redo.",
    412: "The newest revision is not the one in `If-Match`, or there is one.",
    413: "The body, or the document, exceeds a limit.",
    415: "The body is of a kind that is not taken.",
    422: "The document contradicts itself, an edit does not fit it, or the key was used before.",
    428: "This service wants an `If-Match`.",
    500: "A worker process died over the document, twice.",
    504: "The work took too long.",
    507: "As many programs are stored as this service takes.",
}

_EDITS = {
    "edits": [
        {"type": "add_item", "item": {"id": "w", "label": "W"}},
        {"type": "connect", "id": "e", "attachments": [{"item": "w"}]},
    ]
}


def describe_document() -> dict[str, Any]:
    """Of the call that gets a document."""
    return _described(
        {
            200: {
                "description": "The document in canonical form.",
                "headers": headers("ETag", "Content-Disposition", "Tubeloom-Revision"),
                "content": {"application/json": {"schema": reference("Program")}},
            },
            304: _UNCHANGED,
        },
        _WRONG,
    )


def describe_list(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """What may go wrong with a list, and with these ``statuses`` besides."""
    return {status: problem(_CALL, _WRONG[status]) for status in (400, *statuses, 503)}


def describe_view(call: str) -> dict[str, Any]:
    """Of a ``call`` (render, layout, convert) that shows a stored program."""
    names = [
        "ETag",
        "Vary",
        "Content-Disposition",
        "Server-Timing",
        "Tubeloom-Cache",
        "Tubeloom-Stopped-By",
        "Tubeloom-Revision",
    ]
    if call == "render":
        names.append("Tubeloom-Since")
    found = {
        200: {
            "description": "The answer.",
            "headers": headers(*names),
            "content": contents(call),
        },
        304: _UNCHANGED,
    }
    return _described(found, {**_WRONG, **_WRONG_VIEW}, call)


def describe_events() -> dict[str, Any]:
    """Of the call that watches a program."""
    content = {"text/event-stream": {"schema": {"type": "string"}}}
    return _described({200: {"description": "Events, without end.", "content": content}}, _WRONG)


def describe_change(call: str) -> dict[str, Any]:
    """Of a ``call`` (put, patch, edits, undo, redo, delete) that changes a program."""
    revision = {
        "headers": headers("ETag", "Tubeloom-Revision"),
        "content": {"application/json": {"schema": reference("RevisionModel")}},
    }
    found: dict[int, Any] = {200: {"description": "The newest revision.", **revision}}
    if call == "put":
        found[201] = {"description": "The first revision of a new program.", **revision}
    if call == "delete":
        found = {204: {"description": "Deleted."}}
    described = _described(found, {**_WRONG, **_WRONG_CHANGE})
    described["openapi_extra"] = {"parameters": _PARAMETERS}
    content = _bodies(call)
    if content:
        described["openapi_extra"]["requestBody"] = {"required": True, "content": content}
    return described


def _described(
    found: Mapping[int, Any], wrong: Mapping[int, str], call: str = _CALL
) -> dict[str, Any]:
    problems = {status: problem(call, detail) for status, detail in wrong.items()}
    return {"response_model": None, "responses": {**found, **problems}}


def _bodies(call: str) -> dict[str, Any]:
    match call:
        case "put":
            return documents()
        case "edits":
            return {"application/json": {"schema": reference("EditList"), "example": _EDITS}}
        case "patch":
            return {
                JSON_PATCH: {
                    "schema": reference("JsonPatchDocument"),
                    "example": [{"op": "add", "path": "/name", "value": EXAMPLE["name"]}],
                },
                MERGE_PATCH: {"schema": {"type": "object"}, "example": {"style": {"halo": 0.5}}},
            }
        case _:
            return {}


def _header(name: str, description: str) -> dict[str, Any]:
    return {
        "name": name,
        "in": "header",
        "required": False,
        "schema": {"type": "string"},
        "description": description,
    }


_PARAMETERS = [
    _header("If-Match", "The ETag of the revision that is to be changed."),
    _header("Idempotency-Key", "Anything; the same again gets the same answer, for a day."),
]

_UNCHANGED = {
    "description": "The client has this answer already (`If-None-Match`).",
    "headers": headers("ETag", "Vary"),
}
