"""Query parameters as pydantic models, strict about names: typos must not pass in silence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, GetCoreSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from app.answers import LayoutWishes
from app.formats.registry import FORMATS
from app.output.media import Compression, Motion, Parts, Quality, SceneFormat
from app.program.model import Bundles, Clearance, PlacementMode, Routing


@dataclass(frozen=True, slots=True)
class OneOf:
    """Metadata for ``Annotated[str, …]``: nothing but these names."""

    names: tuple[str, ...]

    def __get_pydantic_core_schema__(
        self, _source: Any, _handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.literal_schema(list(self.names))


def _true_or_false(value: object) -> bool:
    if value not in {"true", "false"}:
        raise PydanticCustomError("flag", "Input should be 'true' or 'false'")
    return value == "true"


Readable = Annotated[str, OneOf(tuple(FORMATS))]
Writable = Annotated[str, OneOf(tuple(name for name, found in FORMATS.items() if found.writes))]
Flag = Annotated[bool, BeforeValidator(_true_or_false)]
Seconds = Annotated[float, Field(ge=0.05, le=3600, allow_inf_nan=False)]
Pixels = Annotated[int, Field(ge=1, le=8192)]


class Query(BaseModel):
    """What may stand after the question mark."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class PostedQuery(Query):
    """What may be asked of any call that takes a document."""

    source: Readable | None = Field(
        None,
        alias="from",
        description="Format of the posted document; left out, its media type tells.",
    )


class LaidOutQuery(PostedQuery):
    """What may be asked of the layout of a posted document, whatever its format can say of it."""

    routing: Routing | None = Field(
        None, description="As `layout.routing` of a document, before which it goes."
    )
    placement: PlacementMode | None = Field(
        None, description="As `layout.placement` of a document, before which it goes."
    )
    bundles: Bundles | None = Field(
        None, description="As `layout.bundles` of a document, before which it goes."
    )
    clearance: Clearance | Literal["none"] | None = Field(
        None,
        description="As `layout.clearance` of a document, before which it goes; `none`: its null.",
    )

    @property
    def wishes(self) -> LayoutWishes:
        """What is asked, by the document's keys."""
        asked: list[tuple[str, float | str | None]] = []
        modes = (
            ("routing", self.routing),
            ("placement", self.placement),
            ("bundles", self.bundles),
        )
        asked.extend(mode for mode in modes if mode[1] is not None)
        if self.clearance is not None:
            asked.append(("clearance", None if self.clearance == "none" else self.clearance))
        return tuple(asked)


class SceneQuery(Query):
    """What may be asked of a scene."""

    format: SceneFormat | None = Field(
        None, description="Format of the answer. It wins over `Accept`; without both, `glb`."
    )
    width: Pixels = Field(
        1024, description="Of the picture, in pixels; with the height, the aspect of the camera."
    )
    height: Pixels = Field(768, description="Of the picture, in pixels.")
    quality: Quality = Field(
        "draft",
        description="How a picture is drawn: `draft` at once, `final` path traced, in seconds.",
    )
    samples: int | None = Field(
        None, ge=1, le=65536, description="Of a final picture, for each pixel."
    )
    time_limit: Seconds | None = Field(
        None,
        description="Of final pictures, in seconds: then the best so far is the answer, and the "
        "header `Tubeloom-Stopped-By` says so.",
    )
    noise: float | None = Field(
        None,
        gt=0,
        le=1,
        allow_inf_nan=False,
        description="Of a final picture: the standard error that is good enough, white being 1.",
    )
    denoise: Flag = Field(True, description="Of a final picture: whether noise is smoothed.")
    seed: int = Field(0, ge=0, lt=2**31, description="Of the noise of a final picture.")
    motion: Motion | None = Field(
        None, description="How `webp` and `mp4` move (left out: turntable), and glTF, if it does."
    )
    frames: int = Field(36, ge=2, le=1000, description="Of `webp` and `mp4`.")
    duration: Seconds = Field(3.0, description="Of what moves, in seconds.")
    sheet: Flag = Field(False, description="As `png`: the scene from several sides.")
    sweep: Annotated[
        list[Annotated[str, Field(max_length=1000)]],
        Field(
            max_length=2,
            description="As `png`: variations of the document beside each other, over one or two "
            "axes: a JSON pointer and its values, such as `/style/halo=0,0.3,0.6`.",
        ),
    ] = []
    errors: Literal["json", "image"] = Field(
        "json", description="Whether problems come as JSON, or as a picture for pages that embed."
    )
    scale: float = Field(
        10.0,
        ge=0.001,
        le=1000.0,
        allow_inf_nan=False,
        description="Of a print (`stl`, `3mf`): millimetres to a unit of the document.",
    )
    parts: Parts = Field("all", description="Of a print: what of the scene it holds.")
    compress: Compression = Field(
        "none",
        description="Of glTF: `quantize` (KHR_mesh_quantization) or `meshopt` "
        "(EXT_meshopt_compression besides).",
    )
    merge: Flag | None = Field(
        None,
        description="Of glTF: draw many hyperedges at once, with the number of each at its "
        "vertices; left out, above 1,000 hyperedges.",
    )


class RenderQuery(SceneQuery, LaidOutQuery):
    """What may be asked of the scene of a posted document."""


class NumbersQuery(Query):
    """What may be asked of a layout."""

    patches: Flag = Field(
        False, description="Add the paper's pair of Bezier patches to each segment."
    )


class LayoutQuery(NumbersQuery, LaidOutQuery):
    """What may be asked of the layout of a posted document."""


class ConvertQuery(PostedQuery):
    """What may be asked of a conversion."""

    target: Writable = Field("tubeloom", alias="to", description="Format of the answer.")


Revision = Annotated[
    int | None,
    Field(ge=1, lt=2**31, description="An older revision, if it is kept; left out, the newest."),
]


class StoredSceneQuery(SceneQuery):
    """What may be asked of the scene of a stored program."""

    revision: Revision = None
    since: int | None = Field(
        None,
        ge=1,
        lt=2**31,
        description="As glTF: only the nodes that changed after this revision, and in the scene's "
        "extras (`delta`) the ids of what was removed. Where all must be shown anew, or that "
        "revision is not kept, the whole scene comes, and the header `Tubeloom-Since` is missing.",
    )


class StoredNumbersQuery(NumbersQuery):
    """What may be asked of the layout of a stored program."""

    revision: Revision = None


class StoredConvertQuery(Query):
    """What may be asked of a conversion of a stored program."""

    target: Writable = Field("tubeloom", alias="to", description="Format of the answer.")
    revision: Revision = None


class RevisionQuery(Query):
    """Which revision is meant."""

    revision: Revision = None
