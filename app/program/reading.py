"""From bytes to a checked program, with every fault named by its place in the document."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from app.errors import Fault, InvalidDocument, UnreadableDocument, pointer
from app.program.advice import advice
from app.program.checking import check
from app.program.model import Program
from app.settings import Settings

Model = TypeVar("Model", bound=BaseModel)

MOST_FAULTS = 100
"""More than so many faults in one document tell nobody anything."""


def read_program(data: bytes, settings: Settings) -> Program:
    """The program in the JSON document ``data``.

    Raises `UnreadableDocument` where it is not JSON, `InvalidDocument` where it does not follow the
    schema, and what `app.program.checking.check` raises; each with every fault found.
    """
    program = validate(Program, data)
    check(program, settings)
    return program


def validate(model: type[Model], data: bytes) -> Model:
    """The JSON document ``data`` as ``model``.

    Raises `UnreadableDocument` or `InvalidDocument` with every fault found.
    """
    try:
        return model.model_validate_json(data, strict=True)
    except ValidationError as error:
        details = error.errors(include_url=False)
        if details[0]["type"] == "json_invalid":
            raise UnreadableDocument([_syntax_fault(details[0])]) from None
        raise InvalidDocument(_faults(details, data)) from None


def _syntax_fault(detail: ErrorDetails) -> Fault:
    reason = str(detail.get("ctx", {}).get("error", detail["msg"]))
    if "recursion limit" in reason:
        return Fault("", "Nested too deeply; a program needs no more than some ten levels.")
    return Fault("", f"Not JSON: {reason}.")


def _faults(details: Iterable[ErrorDetails], data: bytes) -> list[Fault]:
    document = json.loads(data)
    faults: list[Fault] = []
    more = 0
    for detail in details:
        if len(faults) >= MOST_FAULTS:
            more += 1
            continue
        place = _place(document, detail["loc"])
        fault = Fault(pointer(*place), advice(detail, place))
        if fault not in faults:
            faults.append(fault)
    if more:
        faults.append(Fault("", f"And {more} more faults."))
    return faults


def _place(document: Any, location: tuple[int | str, ...]) -> list[int | str]:
    """``location`` without what pydantic adds to it, such as the tag of a union's member."""
    place: list[int | str] = []
    here = document
    for position, part in enumerate(location):
        last = position == len(location) - 1
        if isinstance(here, dict) and isinstance(part, str) and (part in here or last):
            place.append(part)
            here = here.get(part)
        elif isinstance(here, list) and isinstance(part, int):
            place.append(part)
            here = here[part] if part < len(here) else None
    return place
