"""From bytes to a checked program, with every fault named by its place in the document."""

from __future__ import annotations

from typing import TypeVar

from pydantic import BaseModel, JsonValue, ValidationError
from pydantic_core import ErrorDetails

from app.errors import Fault, InvalidDocument, pointer
from app.program.advice import advice, is_echo
from app.program.checking import check
from app.program.collection import collection_paused
from app.program.csg import refuse_large_trees
from app.program.faults import first
from app.program.hints import Hints
from app.program.limits import count_entries, refuse_too_many
from app.program.model import Program
from app.program.parsing import parse
from app.program.places import Place, place
from app.program.tally import Tally
from app.settings import Settings

Model = TypeVar("Model", bound=BaseModel)


def read_program(data: bytes, settings: Settings) -> Program:
    """The program in the JSON document ``data``.

    Raises `UnreadableDocument` where it is not JSON, `InvalidDocument` where it does not follow the
    schema, and what `app.program.checking.check` raises; each with every fault found, up to a
    hundred. What there is too much of is refused before it is looked at.
    """
    with collection_paused():
        return program_of(parse(data, settings), settings)


def program_of(document: JsonValue, settings: Settings) -> Program:
    """The program in a JSON value, which is checked as `read_program` checks it."""
    refuse_too_many(count_entries(document), settings)
    refuse_large_trees(document, settings)
    program = validate(Program, document)
    check(program, settings)
    return program


def validate(model: type[Model], document: JsonValue) -> Model:
    """``document`` as ``model``. Raises `InvalidDocument` with every fault found."""
    tally = Tally()
    try:
        return model.model_validate(document, context=tally, by_alias=True, by_name=False)
    except ValidationError as error:
        faults = _faults(model, error.errors(include_url=False))
        raise InvalidDocument(first(faults, at_least=tally.full)) from None


def _faults(model: type[BaseModel], details: list[ErrorDetails]) -> list[Fault]:
    """One fault for each place; where a union has no member that fits, there are many details."""
    places: dict[Place, list[ErrorDetails]] = {}
    for detail in details:
        if not is_echo(detail):
            places.setdefault(place(model, detail["loc"]), []).append(detail)
    hints = Hints()
    return [
        Fault(pointer(*where.way, *_tag(found[0])), advice(found, where.keys, hints))
        for where, found in places.items()
    ]


def _tag(detail: ErrorDetails) -> tuple[str, ...]:
    """The key that says which member of a union is meant, where it says one that does not exist."""
    if detail["type"] != "union_tag_invalid":
        return ()
    return (str(detail["ctx"]["discriminator"]).strip("'"),)
