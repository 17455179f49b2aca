"""Changes of a document by its JSON: JSON Patch (RFC 6902) and JSON Merge Patch (RFC 7396).

They apply to the canonical form, in which a stored program is handed out: what equals its default
is not in it.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import jsonpatch
import jsonpointer
from pydantic import BaseModel, ConfigDict, Field, JsonValue, RootModel
from pydantic_core import from_json, to_json

from app.errors import DocumentTooLarge, Fault, InvalidDocument, PatchConflict, pointer
from app.program.merging import merged
from app.program.model import Program
from app.program.parsing import parse
from app.program.reading import program_of, validate
from app.settings import Settings

MOST_OPERATIONS = 10_000

MOST_COPIED = 100_000
"""Values that the operations of one patch may copy and compare together."""

DEEPEST = 200
"""As deep as documents are read."""

Pointer = Annotated[str, Field(pattern=r"^(/([^~/]|~[01])*)*$", max_length=10_000)]


class _Operation(BaseModel):
    model_config = ConfigDict(strict=True, frozen=True)  # RFC 6902: other members are ignored

    path: Pointer


class _Add(_Operation):
    op: Literal["add"]
    value: JsonValue


class _Replace(_Operation):
    op: Literal["replace"]
    value: JsonValue


class _Test(_Operation):
    op: Literal["test"]
    value: JsonValue


class _Remove(_Operation):
    op: Literal["remove"]


class _Move(_Operation):
    op: Literal["move"]
    origin: Pointer = Field(alias="from")


class _Copy(_Operation):
    op: Literal["copy"]
    origin: Pointer = Field(alias="from")


Operation = Annotated[_Add | _Replace | _Test | _Remove | _Move | _Copy, Field(discriminator="op")]


class JsonPatchDocument(RootModel[list[Operation]]):
    """A JSON Patch: operations that are done one after another, all of them or none."""

    root: list[Operation] = Field(max_length=MOST_OPERATIONS)


def apply_json_patch(document: bytes, data: bytes, settings: Settings) -> Program:
    """The program that the JSON Patch ``data`` makes of ``document``.

    Raises what reading a program raises, with pointers into the patched document; and, with
    pointers into the patch, `PatchConflict` where an operation does not fit the document.
    """
    patch = parse(data, settings)
    validate(JsonPatchDocument, patch)
    patched: Any = parse(document, settings)
    if not isinstance(patch, list):
        raise InvalidDocument([Fault("", "A JSON Patch is a list of operations.")])
    room = min(settings.max_values, MOST_COPIED)
    for number, operation in enumerate(patch):
        if not isinstance(operation, dict):
            continue
        if operation["op"] in {"copy", "test"}:
            # Copies of copies grow by powers of two.
            room -= _size(_at(patched, operation.get("from", operation["path"])), room)
            if room <= 0:
                raise DocumentTooLarge(
                    [Fault(pointer(number), "Copies make the document too large.")]
                )
        try:
            step = jsonpatch.JsonPatch([_without_copy(operation, patched)])
            patched = step.apply(patched, in_place=True)
        except (jsonpatch.JsonPatchException, jsonpointer.JsonPointerException) as error:
            raise PatchConflict([Fault(pointer(number), _reason(operation, error))]) from None
        except (TypeError, RecursionError, ValueError):
            raise PatchConflict(
                [Fault(pointer(number), "This operation does not fit the document.")]
            ) from None
    _size(patched, settings.max_values)
    return program_of(patched, settings)


def apply_merge_patch(document: bytes, data: bytes, settings: Settings) -> Program:
    """The program that the JSON Merge Patch ``data`` makes of ``document``.

    Lists, ``items`` and ``hyperedges`` among them, are replaced as a whole. Raises what reading a
    program raises, with pointers into the patched document.
    """
    return program_of(merged(parse(document, settings), parse(data, settings)), settings)


def _without_copy(operation: dict[str, Any], document: Any) -> dict[str, Any]:
    """The same operation; a copy as an addition, since the library's copies are slow."""
    if operation["op"] != "copy":
        return operation
    found = jsonpointer.JsonPointer(operation["from"]).resolve(document)
    return {"op": "add", "path": operation["path"], "value": from_json(to_json(found))}


def _at(document: Any, place: Any) -> Any:
    """What is at a place, or nothing."""
    try:
        return jsonpointer.JsonPointer(place).resolve(document)
    except jsonpointer.JsonPointerException:
        return None


def _size(value: Any, most: int) -> int:
    """How many values there are, up to ``most``. Raises `DocumentTooLarge` for what is too deep."""
    level, count = [value], 0
    for _depth in range(DEEPEST + 1):
        count += len(level)
        if not level or count > most:
            return count
        level = [
            inner
            for outer in level
            if isinstance(outer, dict | list)
            for inner in (outer.values() if isinstance(outer, dict) else outer)
        ]
    raise DocumentTooLarge([Fault("", f"Nested too deeply: at most {DEEPEST} levels are taken.")])


def _reason(operation: dict[str, Any], error: Exception) -> str:
    place = operation["path"] or "the whole document"
    match error:
        case jsonpatch.JsonPatchTestFailed():
            return f"What is at {place} is not what this operation wants to be there."
        case jsonpatch.JsonPatchConflict() | jsonpointer.JsonPointerException():
            return f"There is no such place: {place}" + (
                f", or {operation['from']}." if "from" in operation else "."
            )
        case _:
            return "This operation does not fit the document."
