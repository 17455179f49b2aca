"""What the pipeline can be asked, and what it answers: light, so that anybody may import it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from app.output.effort import Effort
from app.output.media import Compression, Motion, Parts, Quality, SceneFormat


@dataclass(frozen=True, slots=True)
class RenderOptions:
    """What belongs to one picture alone: its format, and its size in pixels.

    ``source`` is the format of the document. The size also gives a glTF camera its aspect. A print
    shows ``parts`` of the scene, ``scale`` millimetres to a unit of the document. glTF is written
    with ``compress``, and with hyperedges merged or not (``None``: if there are very many).

    Pictures are drawn in ``quality``, a final one with ``effort``. What moves has ``frames`` in
    ``seconds``, and a glTF scene moves if there is a ``motion``. A ``sheet`` shows the scene from
    several sides; a ``sweep``, over one or two axes such as ``/style/halo=0,0.3``, shows variations
    of the document beside each other.
    """

    format: SceneFormat = SceneFormat.GLB
    width: int = 1024
    height: int = 768
    quality: Quality = "draft"
    source: str = "tubeloom"
    scale: float = 10.0
    parts: Parts = "all"
    compress: Compression = "none"
    merge: bool | None = None
    effort: Effort = field(default_factory=Effort)
    motion: Motion | None = None
    frames: int = 36
    seconds: float = 3.0
    sheet: bool = False
    sweep: tuple[str, ...] = ()


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


def is_slow(options: Options) -> bool:
    """Whether an answer takes seconds, however small the document.

    >>> is_slow(RenderOptions(SceneFormat.PNG)), is_slow(RenderOptions(SceneFormat.MP4))
    (False, True)
    """
    return isinstance(options, RenderOptions) and (
        options.format.is_animated
        or options.sheet
        or bool(options.sweep)
        or (options.quality == "final" and options.format is SceneFormat.PNG)
    )


ANYTHING = "*"
"""Among known validators: the asker has an answer, whichever it is."""


@dataclass(frozen=True, slots=True)
class Answer:
    """Bytes, what they are, and a strong validator that changes whenever they would.

    There is no validator where the same question may get another answer. ``name`` is the document's
    own, for a file name; ``notes`` tell how the answer came about.
    """

    body: bytes
    media_type: str
    etag: str | None
    name: str | None = None
    notes: Mapping[str, str] = field(default_factory=dict)


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
