"""What there is: notations, materials, palettes, formats."""

from __future__ import annotations

import hashlib
from typing import Any

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, TypeAdapter
from starlette.requests import Request
from starlette.responses import Response

from app.answers import is_known
from app.api.conditions import entity_tag, known_tags
from app.formats.registry import FORMATS
from app.notations.loader import load_notation, notation_names
from app.notations.notation import Notation
from app.output.media import SceneFormat
from app.program.model import Finish

UNCHANGED: dict[int | str, dict[str, Any]] = {
    304: {"description": "The client has this answer already (`If-None-Match`)."}
}

router = APIRouter(prefix="/v1", tags=["catalogue"], responses=UNCHANGED)


class Entry(BaseModel):
    """Something with a name that documents or queries use."""

    model_config = ConfigDict(from_attributes=True)

    name: str
    title: str


class MaterialEntry(Entry):
    """A kind of surface, as glTF describes it."""

    description: str
    metallic: float
    roughness: dict[Finish, float]
    usual_finish: Finish
    opacity: float
    transmission: float
    ior: float
    clearcoat: float
    texture: str | None = None
    natural_color: str | None = None
    is_lit: bool


class PaletteEntry(Entry):
    """Colours for hyperedges, in the order in which they are given out."""

    description: str
    colors: tuple[str, ...]


class DocumentFormat(Entry):
    """A format of documents."""

    description: str
    media_type: str
    reads: bool
    writes: bool


class SceneFormatEntry(Entry):
    """A format of scenes."""

    media_type: str


class Formats(BaseModel):
    """What documents come in, and what scenes are answered as."""

    documents: tuple[DocumentFormat, ...]
    scenes: tuple[SceneFormatEntry, ...]


@router.get("/notations", response_model=list[Notation])
async def notations(request: Request) -> Response:
    """How the kinds of each notation look."""
    return _json(request, list[Notation], [load_notation(name) for name in notation_names()])


@router.get("/materials", response_model=list[MaterialEntry])
async def materials(request: Request) -> Response:
    """The materials that documents may name."""
    from app.scene.materials import SURFACES  # needs NumPy, as nothing else in the service does

    entries = [MaterialEntry.model_validate(surface) for surface in SURFACES.values()]
    return _json(request, list[MaterialEntry], entries)


@router.get("/palettes", response_model=list[PaletteEntry])
async def palettes(request: Request) -> Response:
    """The palettes that documents may name."""
    from app.scene.palette import palettes as all_palettes  # likewise

    entries = [PaletteEntry.model_validate(palette) for palette in all_palettes()]
    return _json(request, list[PaletteEntry], entries)


@router.get("/formats", response_model=Formats)
async def formats(request: Request) -> Response:
    """The formats of documents (`from`, `to`) and of scenes (`format`)."""
    documents = tuple(
        DocumentFormat(
            name=name,
            title=found.title,
            description=found.description,
            media_type=found.media_type,
            reads=True,
            writes=found.writes,
        )
        for name, found in FORMATS.items()
    )
    scenes = tuple(
        SceneFormatEntry(name=scene.value, title=scene.description, media_type=scene.media_type)
        for scene in SceneFormat
    )
    return _json(request, Formats, Formats(documents=documents, scenes=scenes))


def _json(request: Request, shape: Any, value: object) -> Response:
    """``value`` as JSON with a validator, or 304 where the client has it."""
    body = TypeAdapter(shape).dump_json(value, exclude_none=True)
    tag = hashlib.sha256(body).hexdigest()[:32]
    headers = {"ETag": entity_tag(tag), "Cache-Control": "no-cache"}
    if is_known(tag, known_tags(request.headers.get("if-none-match"))):
        return Response(status_code=304, headers=headers)
    return Response(body, media_type="application/json", headers=headers)
