"""What all parts of a document have in common."""

import math
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, JsonValue, StringConstraints
from pydantic_core import PydanticCustomError


class Part(BaseModel):
    """A part of the document: immutable, and strict about keys, so that typos do not pass."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True
    )


Id = Annotated[str, StringConstraints(min_length=1, max_length=200)]
"""Names a part uniquely among its kind."""

Label = Annotated[str, StringConstraints(max_length=500)]

Color = Annotated[str, StringConstraints(pattern=r"^#([0-9A-Fa-f]{3}|[0-9A-Fa-f]{6})$")]
"""An sRGB colour: ``#rgb`` or ``#rrggbb``."""

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
"""A position or direction component, in document units."""

Vector = tuple[Coordinate, Coordinate, Coordinate]


def _finite(data: dict[str, JsonValue]) -> dict[str, JsonValue]:
    waiting: list[JsonValue] = [data]
    while waiting:
        value = waiting.pop()
        if isinstance(value, dict):
            waiting.extend(value.values())
        elif isinstance(value, list):
            waiting.extend(value)
        elif isinstance(value, float) and not math.isfinite(value):
            raise PydanticCustomError("finite_number", "Numbers must be finite")
    return data


Data = Annotated[dict[str, JsonValue], AfterValidator(_finite)]
"""The editor's own: any JSON object. It goes out again as it came in."""
