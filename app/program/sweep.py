"""Variations of a program over one or two of its parameters, for comparing them."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any, TypeAlias

from pydantic import JsonValue
from pydantic_core import from_json

from app.errors import DocumentError, Fault, ImpossibleSweep, pointer
from app.program.checking import check
from app.program.faults import first
from app.program.model import Program
from app.program.reading import validate
from app.settings import Settings

MOST_VALUES = 6
"""Of an axis: more would be too small to compare."""

MOST_AXES = 2

MOST_IN_A_ROW = 3
"""Values of an axis that is alone."""

LONGEST_VALUE = 40
"""Characters of a value in a heading."""

Way: TypeAlias = tuple[str | int, ...]


@dataclass(frozen=True, slots=True)
class Axis:
    """A parameter and its values.

    ``pointer`` is a JSON pointer into the document (RFC 6901), in which ``*`` stands for every
    member of a list or an object.
    """

    pointer: str
    values: tuple[JsonValue, ...]

    @property
    def name(self) -> str:
        """What the parameter is called.

        >>> Axis("/hyperedges/*/radius", (0.1,)).name
        'radius'
        """
        return _keys(self)[-1]

    @property
    def captions(self) -> tuple[str, ...]:
        """Name and value, for each of the values."""
        return tuple(f"{self.name} = {_shown(value)}" for value in self.values)


def parse_axis(text: str) -> Axis:
    """An axis from ``pointer=value,value``; values are JSON, and what is none is a string.

    Raises `ImpossibleSweep` where there is no pointer, no value, or more than `MOST_VALUES`.

    >>> parse_axis("/view/from=[0,-1,0.5],[0,0,1]")
    Axis(pointer='/view/from', values=([0, -1, 0.5], [0, 0, 1]))
    >>> parse_axis("/items/*/material=glass,wood").values
    ('glass', 'wood')
    """
    place, equals, rest = text.partition("=")
    place = place.strip()
    if not equals or not place.startswith("/"):
        advice = "A sweep is a JSON pointer, =, and values, as /style/halo=0,0.3"
        raise ImpossibleSweep([Fault("", f"{advice}; not {_cut(text)}.")])
    values = tuple(_value(part) for part in _parts(rest))
    if not values:
        raise ImpossibleSweep([Fault(place, "A sweep needs values after the =.")])
    if len(values) > MOST_VALUES:
        told = f"{len(values)} values are more than the {MOST_VALUES} that a sweep may have."
        raise ImpossibleSweep([Fault(place, told)])
    return Axis(place, values)


def vary(
    program: Program, axes: Sequence[Axis], limits: Settings
) -> tuple[tuple[Program, ...], ...]:
    """Rows of variations: the first axis across, the second, where there is one, down.

    Many values of one axis alone come in two rows, the first of which is no shorter. Raises
    `ImpossibleSweep` where an axis points at nothing, and with all that is wrong with the first
    variation that is no right document.
    """
    if not 1 <= len(axes) <= MOST_AXES:
        told = f"A sweep is over one or two parameters, not {len(axes)}."
        raise ImpossibleSweep([Fault("", told)])
    _refuse_overlap(axes)
    document = program.model_dump(mode="json", by_alias=True)
    ways = [_places(document, axis) for axis in axes]
    found = []
    # The last axis varies slowest: rows.
    for chosen in product(*(range(len(axis.values)) for axis in reversed(axes))):
        varied = copy.deepcopy(document)
        captions = []
        for axis, places, index in zip(axes, ways, reversed(chosen), strict=True):
            captions.append(axis.captions[index])
            for way in places:
                _put(varied, way, axis.values[index])
        found.append(_checked(varied, ", ".join(captions), limits))
    width = len(axes[0].values)
    if len(axes) == 1 and width > MOST_IN_A_ROW:
        width = -(-width // 2)
    return tuple(tuple(found[start : start + width]) for start in range(0, len(found), width))


def _checked(document: dict[str, Any], label: str, limits: Settings) -> Program:
    try:
        program = validate(Program, document)
        check(program, limits)
    except DocumentError as error:
        faults = [Fault(fault.pointer, f"{fault.detail} (With {label}.)") for fault in error.faults]
        raise ImpossibleSweep(first(faults)) from None
    return program


def _refuse_overlap(axes: Sequence[Axis]) -> None:
    """Two axes that set the same place would leave one of them without effect."""
    for one, other in pairwise(axes):
        steps = zip(_keys(one), _keys(other), strict=False)
        if all("*" in (here, there) or here == there for here, there in steps):
            told = f"{other.pointer} is varied together with this; each can be varied alone."
            raise ImpossibleSweep([Fault(one.pointer, told)])


def _places(document: dict[str, Any], axis: Axis) -> list[Way]:
    """Every place that the axis points at, whose last key need not be there yet."""
    keys = _keys(axis)
    ways: list[tuple[Way, Any]] = [((), document)]
    for depth, key in enumerate(keys):
        is_last = depth == len(keys) - 1
        found = [
            ((*way, step), inner)
            for way, value in ways
            for step, inner in _steps(value, key, is_last)
        ]
        if not found:
            here = pointer(*keys[: depth + 1])
            raise ImpossibleSweep([Fault(here, "There is nothing here to be varied.")])
        ways = found
    return [way for way, _ in ways]


def _keys(axis: Axis) -> list[str]:
    return [part.replace("~1", "/").replace("~0", "~") for part in axis.pointer.split("/")[1:]]


def _steps(value: Any, key: str, is_last: bool) -> Iterator[tuple[str | int, Any]]:
    """The members of a value that a key stands for; a key that is missing is one, at the end."""
    if isinstance(value, dict):
        if key == "*":
            yield from value.items()
        elif key in value or is_last:
            yield key, value.get(key)
    elif isinstance(value, list):
        if key == "*":
            yield from enumerate(value)
        elif key.isdecimal() and key.isascii() and len(key) < 10 and int(key) < len(value):
            yield int(key), value[int(key)]


def _put(document: Any, way: Way, value: JsonValue) -> None:
    for step in way[:-1]:
        document = document[step]
    document[way[-1]] = copy.deepcopy(value)


def _parts(text: str) -> Iterator[str]:
    """What commas part, but those within brackets or quotes."""
    depth, is_quoted, is_escaped, begin = 0, False, False, 0
    for place, character in enumerate(text):
        if is_quoted:
            is_quoted = is_escaped or character != '"'
            is_escaped = character == "\\" and not is_escaped
        elif character == '"':
            is_quoted = True
        elif character in "[{":
            depth += 1
        elif character in "]}":
            depth -= 1
        elif character == "," and depth == 0:
            yield text[begin:place]
            begin = place + 1
    if text.strip():
        yield text[begin:]


def _value(text: str) -> JsonValue:
    try:
        value: JsonValue = from_json(text, allow_inf_nan=False)
    except ValueError:
        return text.strip()
    return value


def _shown(value: JsonValue) -> str:
    return _cut(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False))


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST_VALUE else text[: LONGEST_VALUE - 1] + "…"
