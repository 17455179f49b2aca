"""What all parts of a document have in common."""

import math
from typing import Annotated, Any, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    JsonValue,
    ModelWrapValidatorHandler,
    Strict,
    StringConstraints,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)
from pydantic_core import PydanticCustomError

from app.program.tally import Tally


def tallied(value: Any, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> Any:
    """Validate unless a document that is read has enough faults already."""
    tally = info.context
    return tally.taking(value, handler) if isinstance(tally, Tally) else handler(value)


class Section(BaseModel):
    """A part of anybody's document: immutable, "1" is no number, and faults are tallied."""

    model_config = ConfigDict(frozen=True, strict=True)

    @model_validator(mode="wrap")
    @classmethod
    def _tallied(
        cls, value: Any, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo
    ) -> Self:
        tally = info.context
        return tally.taking(value, handler) if isinstance(tally, Tally) else handler(value)


class Part(Section):
    """A part of our own document: strict about keys too, so that typos do not pass."""

    model_config = ConfigDict(extra="forbid", populate_by_name=True, serialize_by_alias=True)


Element = TypeVar("Element")

Many = Annotated[tuple[Element, ...], Strict(strict=False)]
"""Any number of entries. Python's lists will do: JSON has no tuples."""

Tallied = WrapValidator(tallied)
"""Marks entries that are no `Section` themselves, and of which there may be very many."""

Id = Annotated[str, StringConstraints(min_length=1, max_length=200)]
"""Names a part uniquely among its kind."""

Label = Annotated[str, StringConstraints(max_length=500)]

Color = Annotated[str, StringConstraints(pattern=r"^#([0-9A-Fa-f]{3}|[0-9A-Fa-f]{6})$")]
"""An sRGB colour: ``#rgb`` or ``#rrggbb``."""

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
"""A position or direction component, in document units."""

Vector = Annotated[tuple[Coordinate, Coordinate, Coordinate], Strict(strict=False)]

Degrees = Annotated[float, Field(ge=-360_000, le=360_000, allow_inf_nan=False)]

Length = Annotated[float, Field(ge=1e-3, le=1e5, allow_inf_nan=False)]
"""A size in document units: positive, finite, and within what single precision can draw."""

Size = Annotated[tuple[Length, Length, Length], Strict(strict=False)]


def _orderly(value: JsonValue) -> JsonValue:
    """The same value with its keys in order; refuses numbers that JSON cannot say."""
    if isinstance(value, dict):
        return {key: _orderly(value[key]) for key in sorted(value)}
    if isinstance(value, list):
        return [_orderly(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        raise PydanticCustomError("finite_data", "All numbers in it must be finite")
    return value


def _orderly_object(data: dict[str, JsonValue]) -> dict[str, JsonValue]:
    return {key: _orderly(data[key]) for key in sorted(data)}


Data = Annotated[dict[str, JsonValue], AfterValidator(_orderly_object)]
"""The editor's own: any JSON object.

It goes out again as it came in, whole numbers of any size among it, but with its keys in
alphabetical order: documents that differ in that alone have one digest, and so one answer.
"""
