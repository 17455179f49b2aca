"""What may be asked of a render, as keyword arguments: the query parameters of the service."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypeAlias, TypedDict

Format: TypeAlias = Literal["glb", "gltf", "png", "svg", "stl", "3mf", "webp", "mp4"]

Document: TypeAlias = Mapping[str, Any] | bytes
"""A program, or a document in another format: as JSON values, or as bytes ready to be sent."""


class RenderOptions(TypedDict, total=False):
    """All that may be asked besides the format; what is left out is the service's default."""

    width: int
    height: int
    quality: Literal["draft", "final"]
    samples: int
    time_limit: float
    noise: float
    denoise: bool
    seed: int
    motion: Literal["none", "turntable", "flight"]
    frames: int
    duration: float
    sheet: bool
    sweep: Sequence[str]
    scale: float
    parts: Literal["all", "hyperedges"]
    compress: Literal["none", "quantize", "meshopt"]
    merge: bool


Query: TypeAlias = list[tuple[str, str | int | float | bool | None]]


def query_of(**parameters: object) -> Query:
    """Parameters as they stand in an address; None stands for what is left out."""
    found: Query = []
    for name, value in parameters.items():
        values = value if isinstance(value, list | tuple) else [value]
        found += [(name.rstrip("_"), _text(each)) for each in values if each is not None]
    return found


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def body_of(document: Document | Sequence[Any]) -> bytes:
    """The document as it is sent."""
    if isinstance(document, bytes):
        return document
    return json.dumps(document, ensure_ascii=False, allow_nan=False).encode()
