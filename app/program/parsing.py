"""From bytes to JSON values: quickly, and refusing what other readers would take differently."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from typing import Any

from pydantic import JsonValue
from pydantic_core import from_json, to_json

from app.errors import DocumentTooLarge, Fault, UnreadableDocument, pointer
from app.program.faults import first
from app.settings import Settings

BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def parse(data: bytes, settings: Settings) -> JsonValue:
    """The JSON value in ``data``: UTF-8, nested less than 200 deep, numbers below 4,300 digits.

    Neither NaN nor Infinity are JSON, and a key that stands twice in one object is taken for the
    slip that it is. Raises `UnreadableDocument` with line and column, or with a pointer to each
    such key, and `DocumentTooLarge` for so many values that reading them would take long.
    """
    # Every value but the first stands behind a comma or an opening bracket; commas suffice to see
    # that there are too many, long before there is anything to count.
    values = data.count(b",")
    if values > settings.max_values:
        raise DocumentTooLarge(
            [Fault("", f"{values} values are more than the limit of {settings.max_values}.")]
        )
    try:
        document: JsonValue = from_json(
            data.removeprefix(BYTE_ORDER_MARK), allow_inf_nan=False, cache_strings="keys"
        )
    except ValueError as error:
        raise UnreadableDocument([_syntax_fault(str(error))]) from None
    if _may_repeat_keys(data, document):
        faults = list(_repeated_keys(data))
        if faults:
            raise UnreadableDocument(first(faults))
    return document


def _syntax_fault(reason: str) -> Fault:
    if reason.startswith("recursion limit"):
        place = reason.partition(" at ")[2]
        return Fault("", f"Nested too deeply at {place}: at most 200 levels are read.")
    return Fault("", f"Not JSON: {reason}.")


def _may_repeat_keys(data: bytes, document: JsonValue) -> bool:
    r"""Whether one object in ``data`` may have one key twice, of which ``document`` has the last.

    Where no key is lost, writing the document again gives as many colons; unless one that was
    escaped (``\u003a``) makes up for it.
    """
    return data.count(b":") != to_json(document).count(b":") or rb"\u003" in data


def _repeated_keys(data: bytes) -> Iterator[Fault]:
    """A fault for each key that stands in one object more than once; slowly."""
    document = json.loads(data.removeprefix(BYTE_ORDER_MARK), object_pairs_hook=_Object)
    waiting: list[tuple[Any, tuple[str | int, ...]]] = [(document, ())]
    while waiting:
        value, place = waiting.pop()
        if isinstance(value, _Object):
            for key in value.repeated:
                yield Fault(pointer(*place, key), "This key stands in the object more than once.")
            waiting.extend((inner, (*place, key)) for key, inner in reversed(value.items()))
        elif isinstance(value, list):
            waiting.extend((value[n], (*place, n)) for n in reversed(range(len(value))))


class _Object(dict[str, Any]):
    """An object that remembers which of its keys were given more than once."""

    def __init__(self, pairs: list[tuple[str, Any]]) -> None:
        super().__init__(pairs)
        self.repeated: tuple[str, ...] = ()
        if len(self) < len(pairs):
            times = Counter(key for key, _ in pairs)
            self.repeated = tuple(key for key, number in times.items() if number > 1)
