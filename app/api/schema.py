"""The interface's description (OpenAPI): what bodies and answers hold.

Documents are read as raw bytes, so that workers parse them; therefore their schema is put in here
by hand. ``tubeloom openapi`` writes the whole.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic import BaseModel, Field
from pydantic.json_schema import models_json_schema

from app.api import problems
from app.api.journal import HEADER as REQUEST_ID
from app.formats.registry import FORMATS
from app.output.media import SceneFormat

EXAMPLE = {
    "name": "A relation of three",
    "items": [
        {"id": "x", "label": "X"},
        {"id": "y", "label": "Y", "shape": {"type": "sphere"}},
        {"id": "z", "label": "Z"},
    ],
    "hyperedges": [
        {"id": "e", "label": "E", "attachments": [{"item": "x"}, {"item": "y"}, {"item": "z"}]}
    ],
}

DOCUMENTS: Mapping[str, str] = {
    "tubeloom": "Program",
    "yosys": "Netlist",
    "hif": "Hypergraph",
}
"""The schemas that the documents of each format follow."""

NETLIST = {
    "modules": {
        "inverter": {
            "ports": {
                "a": {"direction": "input", "bits": [2]},
                "y": {"direction": "output", "bits": [3]},
            },
            "cells": {
                "not": {
                    "type": "$not",
                    "port_directions": {"A": "input", "Y": "output"},
                    "connections": {"A": [2], "Y": [3]},
                }
            },
        }
    }
}

HYPERGRAPH = {
    "network-type": "directed",
    "nodes": [{"node": "water", "attrs": {"label": "H₂O"}}],
    "incidences": [
        {"edge": "burning", "node": "hydrogen", "direction": "tail", "weight": 2},
        {"edge": "burning", "node": "oxygen", "direction": "tail"},
        {"edge": "burning", "node": "water", "direction": "head", "weight": 2},
    ],
}

EXAMPLES: Mapping[str, Any] = {"tubeloom": EXAMPLE, "yosys": NETLIST, "hif": HYPERGRAPH}

_REFERENCES = "#/components/schemas/{model}"

_FASTAPI_FAULTS = _REFERENCES.format(model="HTTPValidationError")

_BINARY = {"type": "string", "format": "binary"}

_PROBLEMS: Mapping[int, str] = {
    400: "A parameter, or the document, does not follow its schema.",
    401: "A valid key is needed.",
    403: "The key is not good for this, or a page of a foreign origin asks.",
    406: "No format fits what is accepted.",
    408: "The body did not come in time.",
    413: "The document exceeds a limit.",
    415: "The body is not plain JSON.",
    421: "The service does not answer for the host that is named.",
    422: "The document contradicts itself or cannot be printed, or has too many pixels.",
    429: "Too much was asked lately; `Retry-After` says when to try again.",
    500: "A worker process died over the document, twice.",
    503: "The service is busy, or cannot draw.",
    504: "The work took too long.",
}


_KEY = {
    "type": "http",
    "scheme": "bearer",
    "description": "An API key, as `tubeloom keys create` makes them. A service that serves its "
    "own machine alone needs none.",
}


class Fault(BaseModel):
    """One thing that is wrong: where, and what would be right."""

    pointer: str | None = Field(None, description="Into the document: a JSON pointer.")
    parameter: str | None = Field(None, description="The query parameter.")
    detail: str


class Problem(BaseModel):
    """What went wrong (RFC 9457)."""

    type: str = Field(description="Names the kind of problem; stable.")
    title: str
    status: int
    detail: str
    instance: str | None = Field(None, description="Names the request, as the log does.")
    errors: list[Fault] = Field([], description="Everything that is wrong, not only the first.")


def describe(call: str) -> dict[str, Any]:
    """What FastAPI cannot know of a ``call`` (render, layout, convert), as a route's arguments."""
    return {
        "response_model": None,
        "responses": {
            200: {
                "description": "The answer.",
                "headers": headers(
                    "ETag",
                    "Vary",
                    "Content-Disposition",
                    "Server-Timing",
                    "Tubeloom-Cache",
                    "Tubeloom-Stopped-By",
                ),
                "content": contents(call),
            },
            304: {
                "description": "The client has this answer already (`If-None-Match`).",
                "headers": headers("ETag", "Vary"),
            },
            **{status: problem(call, detail) for status, detail in _PROBLEMS.items()},
        },
        "openapi_extra": {"requestBody": {"required": True, "content": documents()}},
    }


def openapi(app: FastAPI) -> dict[str, Any]:
    """The description of ``app``, with the schemas of documents, numbers and problems."""
    if app.openapi_schema is None:
        # The service itself needs few of the models, and to make them all takes its time.
        from app.api.layout_model import LayoutNumbers
        from app.api.revision_model import RevisionModel
        from app.formats.hypergraph import Hypergraph
        from app.formats.netlist import Netlist
        from app.program.edit_model import EditList
        from app.program.model import Program
        from app.program.patching import JsonPatchDocument

        described = get_openapi(
            title=app.title,
            version=app.version,
            summary=app.summary,
            description=app.description,
            license_info=app.license_info,
            routes=app.routes,
            tags=app.openapi_tags,
        )
        _, ours = models_json_schema(
            [
                (Program, "validation"),
                (Netlist, "validation"),
                (Hypergraph, "validation"),
                (LayoutNumbers, "validation"),
                (EditList, "validation"),
                (JsonPatchDocument, "validation"),
                (RevisionModel, "serialization"),
                (Problem, "validation"),
            ],
            ref_template=_REFERENCES,
        )
        schemas = described.setdefault("components", {}).setdefault("schemas", {})
        _drop_faults_of_fastapi(described)
        schemas.update(ours["$defs"])
        described["components"]["schemas"] = dict(sorted(schemas.items()))
        described["components"]["securitySchemes"] = {"key": _KEY}
        described["security"] = [{}, {"key": []}]
        app.openapi_schema = described
    return app.openapi_schema


def _drop_faults_of_fastapi(described: dict[str, Any]) -> None:
    """Wrong parameters get a 400 here, and not the 422 that FastAPI would give."""
    for operations in described["paths"].values():
        for operation in operations.values():
            content = operation["responses"].get("422", {}).get("content", {})
            if content.get("application/json") == {"schema": {"$ref": _FASTAPI_FAULTS}}:
                del operation["responses"]["422"]
    for name in ("HTTPValidationError", "ValidationError"):
        described["components"]["schemas"].pop(name, None)


def openapi_text(app: FastAPI) -> str:
    """The description as it stands in the file ``openapi.json``."""
    return json.dumps(openapi(app), indent=2, ensure_ascii=False) + "\n"


def documents() -> dict[str, Any]:
    """Contents of a body that is a document."""
    return {
        found.media_type: {"schema": reference(DOCUMENTS[name]), "example": EXAMPLES[name]}
        for name, found in FORMATS.items()
    }


def contents(call: str) -> dict[str, Any]:
    """Contents of the answers to a call."""
    match call:
        case "render":
            return {scene.media_type: {"schema": _BINARY} for scene in SceneFormat}
        case "layout":
            return {"application/json": {"schema": reference("LayoutNumbers")}}
        case _:
            return {
                found.media_type: {"schema": reference(DOCUMENTS[name])}
                for name, found in FORMATS.items()
                if found.writes
            }


def problem(call: str, detail: str) -> dict[str, Any]:
    """An answer of a call that tells what went wrong."""
    content: dict[str, Any] = {problems.MEDIA_TYPE: {"schema": reference("Problem")}}
    if call == "render":  # with errors=image
        content |= {each.media_type: {} for each in (SceneFormat.PNG, SceneFormat.SVG)}
    return {"description": detail, "content": content}


def headers(*names: str) -> dict[str, Any]:
    """Headers of an answer."""
    return {name: {"schema": {"type": "string"}} for name in (*names, REQUEST_ID)}


def reference(model: str) -> dict[str, str]:
    """Where the schema of a model is; `openapi` puts it there."""
    return {"$ref": _REFERENCES.format(model=model)}
