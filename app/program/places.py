"""Where a fault is: from pydantic's locations to the document's own places, by its JSON schema."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from pydantic import BaseModel

Schema = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Place:
    """A way into a document, and the keys that the object around its end may have."""

    way: tuple[str | int, ...]
    keys: tuple[str, ...]


def place(model: type[BaseModel], location: Iterable[str | int]) -> Place:
    """``location`` without what pydantic adds for itself, such as the tag of a union's member.

    >>> from app.program.model import Program
    >>> place(Program, ("items", 3, "shape", "sphere", "radios"))
    Place(way=('items', 3, 'shape', 'radios'), keys=('radius', 'type'))
    """
    schema = _schema(model)
    here: Schema | None = schema
    way: list[str | int] = []
    keys: tuple[str, ...] = ()
    for part in location:
        here = _named(schema, here)
        if here is None:
            break
        if "discriminator" in here:
            here = {"$ref": here["discriminator"]["mapping"].get(part)}
        elif here.get("type") == "object":
            properties: Schema = here.get("properties", {})
            keys = tuple(sorted(properties))
            way.append(part)
            here = properties.get(str(part), here.get("additionalProperties") or None)
        elif here.get("type") == "array" and isinstance(part, int):
            way.append(part)
            fixed = here.get("prefixItems", [])
            here = fixed[part] if part < len(fixed) else here.get("items")
        else:
            break
    return Place(tuple(way), keys)


def _named(schema: Schema, here: Schema | None) -> Schema | None:
    """What a reference or an "… or null" stands for."""
    while isinstance(here, dict):
        if "$ref" in here:
            here = schema["$defs"].get(str(here["$ref"]).rpartition("/")[2])
        elif len(choices := [one for one in here.get("anyOf", ()) if one != {"type": "null"}]) == 1:
            here = choices[0]
        else:
            return here
    return None


@lru_cache(maxsize=16)
def _schema(model: type[BaseModel]) -> Schema:
    return model.model_json_schema(by_alias=True, mode="validation")
