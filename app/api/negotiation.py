"""Which of the formats that there are a client likes best, by its ``Accept`` (RFC 9110, 12.5.1)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from app.api.problems import NotAcceptableError

Format = TypeVar("Format")

MOST_RANGES = 100
"""Of an ``Accept`` header, that are read; browsers send some ten."""

MOST_REPEATED = 200
"""Characters of an ``Accept`` header that a message repeats."""

_QUALITY = re.compile(r"0(\.\d{0,3})?|1(\.0{0,3})?")


@dataclass(frozen=True, slots=True)
class Range:
    """Media types that a client accepts, and how much it likes them (0: not at all)."""

    type: str
    subtype: str
    quality: float

    def closeness(self, media_type: str) -> int:
        """How exactly this range names ``media_type``: 0 (not at all) to 3."""
        kind, _, subtype = media_type.partition("/")
        if (self.type, self.subtype) == (kind, subtype):
            return 3
        if (self.type, self.subtype) == (kind, "*"):
            return 2
        return 1 if (self.type, self.subtype) == ("*", "*") else 0


def choose(accept: str | None, offers: Mapping[str, Format]) -> Format:
    """What stands beside the media type that ``accept`` likes best; the first of equals.

    Raises `NotAcceptableError` where nothing is accepted.

    >>> offers = {"model/gltf-binary": "glb", "image/png": "png"}
    >>> choose("image/*, model/gltf-binary;q=0.5", offers), choose(None, offers)
    ('png', 'glb')
    """
    if accept is None or accept == "*/*":  # as most clients say: everything is equal
        return next(iter(offers.values()))
    ranges = parse_accept(accept or "*/*")
    qualities = {media_type: _quality(media_type, ranges) for media_type in offers}
    best = max(qualities, key=qualities.__getitem__)
    if qualities[best] <= 0:
        raise NotAcceptableError(
            f"Accepted is {accept[:MOST_REPEATED]}, but there are only {', '.join(offers)}."
        )
    return offers[best]


def names(media_type: str, accept: str | None) -> bool:
    """Whether ``accept`` asks for ``media_type`` by its name.

    >>> names("text/event-stream", "text/event-stream, image/png"), names("image/png", "*/*")
    (True, False)
    """
    if accept is None or media_type not in accept.lower():
        return False
    return any(
        found.closeness(media_type) == 3 and found.quality > 0 for found in parse_accept(accept)
    )


def without(media_type: str, accept: str | None) -> str | None:
    """What else ``accept`` asks for.

    >>> without("text/event-stream", "text/event-stream, image/png")
    ' image/png'
    """
    if accept is None:
        return None
    others = [part for part in _parts(accept) if media_type_of(part) != media_type]
    return ",".join(others) or None


def parse_accept(accept: str) -> tuple[Range, ...]:
    """The first hundred ranges of an ``Accept`` header; what does not parse is left out."""
    return tuple(found for part in _parts(accept) if (found := _parse_range(part)) is not None)


def media_type_of(header: str) -> str:
    """A ``Content-Type`` without its parameters, in lower case.

    >>> media_type_of("Application/JSON; charset=utf-8")
    'application/json'
    """
    return header.partition(";")[0].strip().lower()


def _parts(accept: str) -> list[str]:
    return accept.split(",", MOST_RANGES)[:MOST_RANGES]


def _parse_range(part: str) -> Range | None:
    kind, _, subtype = media_type_of(part).partition("/")
    pairs = (parameter.partition("=") for parameter in part.split(";")[1:])
    parameters = {name.strip().lower(): value.strip() for name, _, value in pairs}
    quality = parameters.get("q", "1")
    if not (kind and subtype and _QUALITY.fullmatch(quality)):
        return None
    return Range(kind, subtype, float(quality))


def _quality(media_type: str, ranges: Sequence[Range]) -> float:
    """What the range that names ``media_type`` most exactly says of it."""
    closest = max(ranges, key=lambda found: found.closeness(media_type), default=None)
    if closest is None or not closest.closeness(media_type):
        return 0.0
    return closest.quality
