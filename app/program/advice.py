"""What would be right: pydantic's messages, in the words of somebody who wants to help."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache
from typing import Any

from pydantic import BaseModel
from pydantic_core import ErrorDetails

from app.program import model, shapes
from app.program.base import Part

LONGEST_QUOTE = 40
"""Characters of an offending value worth repeating."""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A hint at the known name nearest to ``name``, or nothing.

    >>> did_you_mean("labl", ["label", "kind"])
    ' Did you mean "label"?'
    """
    if len(name) > 200:
        return ""
    matches = get_close_matches(name, list(known), n=1)
    return f' Did you mean "{matches[0]}"?' if matches else ""


def advice(  # noqa: C901, PLR0911, PLR0912 - a table of cases
    detail: ErrorDetails, place: list[int | str]
) -> str:
    """What is wrong and what would be right, as one sentence or two."""
    context: dict[str, Any] = detail.get("ctx", {})
    given = _quote(detail["input"])
    match detail["type"]:
        case "extra_forbidden":
            key = str(place[-1]) if place else ""
            return f"Unknown key.{did_you_mean(key, _keys())}"
        case "missing":
            return "Required, but missing."
        case "literal_error":
            return f"Must be {context['expected']}, not {given}."
        case "union_tag_invalid":
            return f"Must have as type one of {context['expected_tags']}, not {context['tag']!r}."
        case "union_tag_not_found":
            return 'Must be an object with a "type".'
        case "float_type" | "float_parsing" | "int_type":
            return f"Must be a number, not {given}."
        case "finite_number":
            return "Must be a finite number."
        case "string_type":
            return f"Must be a string, not {given}."
        case "bool_type":
            return f"Must be true or false, not {given}."
        case "tuple_type" | "list_type":
            return f"Must be a list, not {given}."
        case "dict_type" | "model_type" | "model_attributes_type":
            return f"Must be an object, not {given}."
        case "greater_than":
            return f"Must be greater than {context['gt']:g}, not {given}."
        case "greater_than_equal":
            return f"Must be at least {context['ge']:g}, not {given}."
        case "less_than_equal":
            return f"Must be at most {context['le']:g}, not {given}."
        case "string_too_short":
            return "Must not be empty."
        case "string_too_long":
            return f"Must have at most {context['max_length']} characters."
        case "too_short":
            least, given = context["min_length"], context["actual_length"]
            return f"Must have at least {least} entries, not {given}."
        case "too_long":
            return f"Must have at most {context['max_length']} entries."
        case "string_pattern_mismatch":
            return f"Must be a colour such as #rrggbb, not {given}."
        case _:
            return f"{detail['msg']}."


def _quote(value: object) -> str:
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list | tuple):
        return "a list"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    text = f'"{value}"' if isinstance(value, str) else repr(value)
    return text if len(text) <= LONGEST_QUOTE else f"{text[:LONGEST_QUOTE]}…"


@lru_cache(maxsize=1)
def _keys() -> tuple[str, ...]:
    """Every key that some part of a document has."""
    parts = [
        part
        for module in (model, shapes)
        for part in vars(module).values()
        if isinstance(part, type) and issubclass(part, Part) and issubclass(part, BaseModel)
    ]
    return tuple(
        sorted({field.alias or name for part in parts for name, field in part.model_fields.items()})
    )
