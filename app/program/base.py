"""What all parts of a document have in common."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints


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
