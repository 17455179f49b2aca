"""Dataclasses from JSON, by their annotations.

What a dataclass does not name is left out, so that a newer service may say more than this client
knows; what it names must be there, unless it has a default.
"""

from __future__ import annotations

import dataclasses
from datetime import datetime
from functools import lru_cache
from types import NoneType, UnionType
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

Decoded = TypeVar("Decoded")


def decode(kind: type[Decoded], value: Any) -> Decoded:
    """``value``, as ``json.loads`` gives it, as the dataclass ``kind``.

    A field named ``from_`` is ``from`` in JSON. Raises `KeyError` where something is missing.
    """
    return cast("Decoded", _decode(kind, value))


def _decode(kind: Any, value: Any) -> Any:
    if dataclasses.is_dataclass(kind):
        return _dataclass(cast("type", kind), value)
    origin = get_origin(kind)
    if origin in {Union, UnionType}:
        (inner,) = (each for each in get_args(kind) if each is not NoneType)
        return None if value is None else _decode(inner, value)
    if origin is tuple:
        inner, *rest = get_args(kind)
        if rest == [...]:
            return tuple(_decode(inner, each) for each in value)
        return tuple(_decode(each, one) for each, one in zip((inner, *rest), value, strict=True))
    if kind is datetime:
        return datetime.fromisoformat(value)
    return float(value) if kind is float else value


def _dataclass(kind: type, value: Any) -> Any:
    given = {}
    for name, key, hint, is_needed in _fields(kind):
        if key in value or is_needed:
            given[name] = _decode(hint, value[key])
    return kind(**given)


@lru_cache
def _fields(kind: type) -> tuple[tuple[str, str, Any, bool], ...]:
    """Of each field its name, its key in JSON, its type, and whether it must be there."""
    hints = get_type_hints(kind)
    return tuple(
        (
            field.name,
            field.name.rstrip("_"),
            hints[field.name],
            field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING,
        )
        for field in dataclasses.fields(kind)
    )
