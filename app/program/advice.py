"""What would be right: pydantic's messages, in the words of somebody who wants to help."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from pydantic_core import ErrorDetails

from app.program.hints import Hints

LONGEST_QUOTE = 40
"""Characters of an offending value worth repeating."""

RIGHT = {
    "bool_type": "Must be true or false",
    "dict_type": "Must be an object",
    "float_parsing": "Must be a number",
    "float_type": "Must be a number",
    "greater_than": "Must be greater than {gt:g}",
    "greater_than_equal": "Must be at least {ge:g}",
    "int_type": "Must be a whole number",
    "less_than_equal": "Must be at most {le:g}",
    "list_type": "Must be a list",
    "literal_error": "Must be {expected}",
    "model_attributes_type": "Must be an object",
    "model_type": "Must be an object",
    "string_pattern_mismatch": "Must be a colour such as #rrggbb",
    "string_type": "Must be a string",
    "tuple_type": "Must be a list",
    "union_tag_invalid": "Must be one of {expected_tags}",
}
"""What comes before "not" and the value that was given, by pydantic's types of errors."""

SENTENCES = {
    "finite_data": "All numbers in it must be finite.",
    "finite_number": "Must be a finite number.",
    "missing": "Required, but missing.",
    "string_too_long": "Must have at most {max_length} characters.",
    "string_too_short": "Must not be empty.",
    "too_long": "Must have at most {max_length} entries, not {actual_length}.",
    "too_many_keys": "Has far more keys than there are.",
    "too_short": "Must have at least {min_length} entries, not {actual_length}.",
    "union_tag_not_found": "Must have a {discriminator}.",
}
"""The same, of what needs no value to be repeated."""


def advice(details: Sequence[ErrorDetails], keys: Collection[str], hints: Hints) -> str:
    """What is wrong at one place and what would be right, as one sentence or two.

    Several ``details`` are those of a union: any of its members would be right. ``keys`` are those
    that the object has, where one is unknown.
    """
    if details[0]["type"] == "float_type" and type(details[0]["input"]) is int:
        return "Must be a number that fits into 64 bits."
    alternatives = [RIGHT[detail["type"]] for detail in details if detail["type"] in RIGHT]
    if len(alternatives) == len(details):
        rules = [
            right.format_map(_context(detail))
            for right, detail in zip(alternatives, details, strict=True)
        ]
        right = " or ".join([rules[0], *(rule.removeprefix("Must be ") for rule in rules[1:])])
        return f"{right}, not {_given(details[0])}."
    detail = next(detail for detail in details if detail["type"] not in RIGHT)
    if detail["type"] == "extra_forbidden":
        return f"Unknown key.{hints.at(str(detail['loc'][-1]), keys)}"
    sentence = SENTENCES.get(detail["type"])
    return sentence.format_map(_context(detail)) if sentence else f"{detail['msg']}."


def is_echo(detail: ErrorDetails) -> bool:
    """Whether a list is only called too short because entries in it are wrong themselves."""
    return (
        detail["type"] == "too_short"
        and isinstance(detail["input"], list)
        and len(detail["input"]) >= _context(detail)["min_length"]
    )


def _context(detail: ErrorDetails) -> Mapping[str, Any]:
    context = detail.get("ctx", {})
    if "discriminator" in context:
        return {**context, "discriminator": str(context["discriminator"]).replace("'", '"')}
    return context


def _given(detail: ErrorDetails) -> str:
    """The offending value as it stands in the document, or what it is where it is long."""
    value = detail["input"]
    if detail["type"] == "union_tag_invalid":
        value = value[_context(detail)["discriminator"].strip('"')]
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list | tuple):
        return "a list"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    text = f'"{value}"' if isinstance(value, str) else repr(value)
    return text if len(text) <= LONGEST_QUOTE else f"{text[:LONGEST_QUOTE]}…"
