"""Sweeps: variations of a program over one or two of its parameters."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from pydantic import JsonValue

from app.errors import DocumentError, Fault, InvalidSweep
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings

MOST_VALUES = 6
"""Of one axis: more pictures beside each other would be too small."""


@dataclass(frozen=True, slots=True)
class Axis:
    """A parameter (a JSON pointer, in which ``*`` stands for every member) and its values."""

    pointer: str
    values: tuple[JsonValue, ...]

    @property
    def captions(self) -> list[str]:
        """One for each value: the parameter's last word, and the value."""
        word = self.pointer.rpartition("/")[2].replace("_", " ")
        return [f"{word}: {_said(value)}" for value in self.values]


def parse_axis(text: str) -> Axis:
    """An axis such as ``/style/halo=0,0.3``. Raises `InvalidSweep`.

    Values are JSON; a word without quotes is a string.

    >>> parse_axis("/view/from=[0,-1,1],[1,0,1]").values
    ([0, -1, 1], [1, 0, 1])
    >>> parse_axis("/style/palette=glasbey,okabe-ito").values
    ('glasbey', 'okabe-ito')
    """
    pointer, equals, listed = text.partition("=")
    if not equals or not pointer.startswith("/"):
        raise InvalidSweep(
            [Fault("", f"A sweep is a JSON pointer and its values, like /style/halo=0,0.3: {text}")]
        )
    values = tuple(_values(listed))
    if not 1 <= len(values) <= MOST_VALUES:
        raise InvalidSweep([Fault(pointer, f"A sweep has 1 to {MOST_VALUES} values.")])
    return Axis(pointer, values)


def vary(program: Program, axes: Sequence[Axis], settings: Settings) -> list[list[Program]]:
    """The variations: a row for each value of the second axis, a column for each of the first.

    Raises `InvalidSweep` where the document has no such place, or a value is wrong there.
    """
    document = program.model_dump(mode="json", by_alias=True, exclude_unset=True)
    across, down = axes[0], axes[1] if len(axes) > 1 else None
    rows: list[list[Program]] = []
    for value in down.values if down else (None,):
        row = copy.deepcopy(document)
        if down is not None:
            _put(row, down.pointer, value)
        cells = []
        for other in across.values:
            cell = copy.deepcopy(row)
            _put(cell, across.pointer, other)
            cells.append(_read(cell, settings))
        rows.append(cells)
    return rows


def _read(document: Any, settings: Settings) -> Program:
    try:
        return read_program(json.dumps(document).encode(), settings)
    except DocumentError as error:
        raise InvalidSweep(error.faults) from error


def _values(listed: str) -> Iterator[JsonValue]:
    decoder = json.JSONDecoder()
    rest = listed
    while rest:
        word = rest.partition(",")[0]
        value, end = word, len(word)
        with suppress(ValueError, RecursionError):
            found, found_end = decoder.raw_decode(rest)
            if rest[found_end : found_end + 1] in {"", ","}:
                value, end = found, found_end
        yield value
        rest = rest[end + 1 :]


def _put(document: Any, pointer: str, value: JsonValue) -> None:
    """Put ``value`` at a place whose parents there are, or could be."""
    parts = [part.replace("~1", "/").replace("~0", "~") for part in pointer.split("/")[1:]]
    _put_below(document, parts, value, pointer)


def _put_below(parent: Any, parts: Sequence[str], value: JsonValue, pointer: str) -> None:
    first, rest = parts[0], parts[1:]
    if isinstance(parent, list):
        for member in _members(parent, first, pointer):
            if rest:
                _put_below(parent[member], rest, value, pointer)
            else:
                parent[member] = value
    elif not isinstance(parent, dict):
        raise InvalidSweep([Fault(pointer, "There is no such place in the document.")])
    elif rest:
        _put_below(parent.setdefault(first, {}), rest, value, pointer)
    else:
        parent[first] = value


def _members(parent: list[Any], part: str, pointer: str) -> list[int]:
    if part == "*":
        return list(range(len(parent)))
    if part.isdecimal() and len(part) < 9 and int(part) < len(parent):
        return [int(part)]
    raise InvalidSweep([Fault(pointer, "There is no such place in the document.")])


def _said(value: JsonValue) -> str:
    return value if isinstance(value, str) else json.dumps(value)
