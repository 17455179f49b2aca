"""What the pipeline can be asked, and what it answers: light, so that anybody may import it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from app.output.effort import Effort
from app.output.media import Compression, Motion, Parts, Quality, SceneFormat
from app.program.changes import Changes


@dataclass(frozen=True, slots=True)
class Delta:
    """What of a stored program changed between two of its revisions, ``since`` and ``revision``.

    ``items`` and ``hyperedges`` are to be shown anew or for the first time.
    """

    since: int
    revision: int
    items: frozenset[str]
    hyperedges: frozenset[str]
    removed_items: tuple[str, ...] = ()
    removed_hyperedges: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Always the same text: the order within a set is another one in every process."""
        return (
            f"Delta({self.since}, {self.revision}, {sorted(self.items)}, "
            f"{sorted(self.hyperedges)}, {self.removed_items}, {self.removed_hyperedges})"
        )


@dataclass(frozen=True, slots=True)
class Stretch:
    """Frames of a film from ``first`` up to ``end``, for which there is this ``share`` of its time.

    They are answered as `app.output.frames` packs them.
    """

    first: int
    end: int
    share: float = 1.0


LayoutWishes: TypeAlias = tuple[tuple[str, float | str | None], ...]
"""What is asked of a posted document's ``layout`` beside what it says itself, key by key."""


@dataclass(frozen=True, slots=True)
class RenderOptions:
    """What belongs to one picture alone: its format, and its size in pixels.

    ``source`` is the format of the document, ``wishes`` go before what it says of its layout. The
    size also gives a glTF camera its aspect. A print
    shows ``parts`` of the scene, ``scale`` millimetres to a unit of the document. glTF is written
    with ``compress``, and with hyperedges merged or not (``None``: if there are very many).

    Pictures are drawn in ``quality``, a final one with ``effort``. What moves has ``frames`` in
    ``seconds``, and a glTF scene moves if there is a ``motion``. A ``sheet`` shows the scene from
    several sides; a ``sweep``, over one or two axes such as ``/style/halo=0,0.3``, shows variations
    of the document beside each other. With a ``delta``, glTF has only what changed; with a
    ``stretch``, a film has only these frames, which `JoinOptions` make a film of.
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
    delta: Delta | None = None
    stretch: Stretch | None = None
    wishes: LayoutWishes = ()


@dataclass(frozen=True, slots=True)
class JoinOptions:
    """Make the ``film`` of its frames, which come in place of the document, stretch by stretch."""

    film: RenderOptions


@dataclass(frozen=True, slots=True)
class LayoutOptions:
    """Whether the numbers come with patch pairs, and the document's format and wishes."""

    patches: bool = False
    source: str = "tubeloom"
    wishes: LayoutWishes = ()


@dataclass(frozen=True, slots=True)
class ConvertOptions:
    """From which format to which."""

    source: str
    target: str = "tubeloom"


@dataclass(frozen=True, slots=True)
class Replacement:
    """Another document, in the format ``source``, instead of the one that there is, if any."""

    data: bytes
    source: str = "tubeloom"


@dataclass(frozen=True, slots=True)
class JsonPatch:
    """A list of operations on the document, as JSON (RFC 6902)."""

    data: bytes


@dataclass(frozen=True, slots=True)
class MergePatch:
    """A document in which what differs stands, as JSON (RFC 7396)."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Edits:
    """Edits by what they mean, as JSON; see `app.program.edits`."""

    data: bytes


@dataclass(frozen=True, slots=True)
class Restoration:
    """The document and the layout of an older revision, to the last byte."""

    document: bytes
    layout: bytes


Change: TypeAlias = Replacement | JsonPatch | MergePatch | Edits | Restoration


@dataclass(frozen=True, slots=True)
class ReviseOptions:
    """Make the next revision of a stored program."""

    change: Change


Options: TypeAlias = RenderOptions | LayoutOptions | ConvertOptions | ReviseOptions | JoinOptions


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


@dataclass(frozen=True, slots=True)
class Revised:
    """A revision of a stored program: its document in canonical form, and its layout as bytes.

    ``changes`` are those since the revision before; of a first one, everything is added. Where
    there was not time enough for the layout, it is not ``complete``.
    """

    document: bytes
    layout: bytes
    digest: str
    name: str | None
    items: int
    hyperedges: int
    changes: Changes
    complete: bool = True


def is_known(etag: str, known: frozenset[str]) -> bool:
    """Whether an asker who has the answers ``known`` has this one.

    >>> is_known("a", frozenset({"a", "b"})), is_known("a", frozenset({ANYTHING}))
    (True, True)
    """
    return etag in known or ANYTHING in known
