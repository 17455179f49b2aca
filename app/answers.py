"""What the pipeline can be asked, and what it answers: light, so that anybody may import it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from app.output.media import Compression, Parts, SceneFormat


@dataclass(frozen=True, slots=True)
class RenderOptions:
    """What belongs to one picture alone: its format, and its size in pixels.

    ``source`` is the format of the document. The size also gives a glTF camera its aspect. A print
    shows ``parts`` of the scene, ``scale`` millimetres to a unit of the document. glTF is written
    with ``compress``, and with hyperedges merged or not (``None``: if there are very many).
    """

    format: SceneFormat = SceneFormat.GLB
    width: int = 1024
    height: int = 768
    quality: Literal["draft"] = "draft"
    source: str = "tubeloom"
    scale: float = 10.0
    parts: Parts = "all"
    compress: Compression = "none"
    merge: bool | None = None


@dataclass(frozen=True, slots=True)
class LayoutOptions:
    """Whether the numbers come with patch pairs, and the format of the document."""

    patches: bool = False
    source: str = "tubeloom"


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """From which format to which."""

    source: str
    target: str = "tubeloom"


Options: TypeAlias = RenderOptions | LayoutOptions | ConvertOptions

ANYTHING = "*"
"""Among known validators: the asker has an answer, whichever it is."""


@dataclass(frozen=True, slots=True)
class Answer:
    """Bytes, what they are, and a strong validator that changes whenever they would.

    ``name`` is the document's own, for a file name.
    """

    body: bytes
    media_type: str
    etag: str
    name: str | None = None


@dataclass(frozen=True, slots=True)
class Unchanged:
    """The asker has this answer already."""

    etag: str


def is_known(etag: str, known: frozenset[str]) -> bool:
    """Whether an asker who has the answers ``known`` has this one.

    >>> is_known("a", frozenset({"a", "b"})), is_known("a", frozenset({ANYTHING}))
    (True, True)
    """
    return etag in known or ANYTHING in known
