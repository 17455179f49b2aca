"""The calls that take a document: render, layout, convert."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Annotated

from fastapi import APIRouter
from fastapi import Query as QueryParameters
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response

from app.answers import ConvertOptions, LayoutOptions, Options, RenderOptions
from app.api import events
from app.api.bodies import declared_media_type, read_document
from app.api.conditions import known_tags
from app.api.negotiation import choose, names, without
from app.api.problems import ContradictionError
from app.api.queries import ConvertQuery, LayoutQuery, Query, RenderQuery
from app.api.responses import response_of
from app.api.schema import describe
from app.formats.registry import FORMATS
from app.jobs.executor import Finished, WorkerPool
from app.output.effort import Effort
from app.output.media import SceneFormat
from app.settings import Settings

router = APIRouter(prefix="/v1", tags=["programs"], default_response_class=Response)

SCENES: Mapping[str, SceneFormat] = {scene.media_type: scene for scene in SceneFormat}
NUMBERS: Mapping[str, str] = {"application/json": "json"}


@router.post("/render", **describe("render"))
async def render(request: Request, query: Annotated[RenderQuery, QueryParameters()]) -> Response:
    """The scene of the posted program, as glTF, as a picture or a film, or for a printer.

    Without `format`, `Accept` decides; without both it is `model/gltf-binary`. Where `Accept` names
    `text/event-stream` too, the answer comes as the last of server-sent events that tell how the
    work goes on: `progress`, `preview`, `answer`, `problem`.
    """
    accept = request.headers.get("accept")
    options = _render_options(query, _format(query, without(events.MEDIA_TYPE, accept)), request)
    if names(events.MEDIA_TYPE, accept):
        document = await read_document(request, request.app.state.settings.max_body_bytes)
        pool: WorkerPool = request.app.state.pool
        return events.event_response(request, pool, document, options, options.format.value)
    return await _answer(request, options, options.format.value)


@router.post("/layout", **describe("layout"))
async def layout(request: Request, query: Annotated[LayoutQuery, QueryParameters()]) -> Response:
    """The numbers: where items stand, and the control points of every hyperedge's curves."""
    ending = choose(request.headers.get("accept"), NUMBERS)
    return await _answer(request, LayoutOptions(query.patches, _source(request, query)), ending)


@router.post("/convert", **describe("convert"))
async def convert(request: Request, query: Annotated[ConvertQuery, QueryParameters()]) -> Response:
    """The posted document in another format."""
    ending = choose(request.headers.get("accept"), {FORMATS[query.target].media_type: "json"})
    return await _answer(request, ConvertOptions(_source(request, query), query.target), ending)


def _format(query: RenderQuery, accept: str | None) -> SceneFormat:
    if not (query.sheet or query.sweep):
        return query.format or choose(accept, SCENES)
    if query.sheet and query.sweep:
        raise ContradictionError("A picture is either a sheet of views or a sweep.")
    if query.format not in {None, SceneFormat.PNG}:
        raise ContradictionError(f"Sheets and sweeps are pictures: png, not {query.format}.")
    return choose(accept, {SceneFormat.PNG.media_type: SceneFormat.PNG})


def _render_options(query: RenderQuery, wanted: SceneFormat, request: Request) -> RenderOptions:
    return RenderOptions(
        format=wanted,
        width=query.width,
        height=query.height,
        quality=query.quality,
        source=_source(request, query),
        scale=query.scale,
        parts=query.parts,
        compress=query.compress,
        merge=query.merge,
        effort=Effort(query.samples, query.time_limit, query.noise, query.denoise, query.seed),
        motion=query.motion,
        frames=query.frames,
        seconds=query.duration,
        sheet=query.sheet,
        sweep=tuple(query.sweep),
    )


def _source(request: Request, query: Query) -> str:
    """The format of the posted document: as asked, or as its media type tells."""
    if query.source is not None:
        return query.source
    media_type = declared_media_type(request.headers)
    return next(
        (name for name, found in FORMATS.items() if found.media_type == media_type), "tubeloom"
    )


async def _answer(request: Request, options: Options, ending: str) -> Response:
    settings: Settings = request.app.state.settings
    document = await read_document(request, settings.max_body_bytes)
    finished = await _unless_gone(
        request, document, options, known_tags(request.headers.get("if-none-match"))
    )
    return response_of(finished, ending)


async def _unless_gone(
    request: Request, document: bytes, options: Options, known: frozenset[str]
) -> Finished:
    """The workers' answer. Raises `ClientDisconnect`, and stops them, when nobody waits for it."""
    pool: WorkerPool = request.app.state.pool
    work = asyncio.create_task(pool.answer(document, options, known))
    # The body has been read, so the only message that can still come is the disconnection.
    gone = asyncio.ensure_future(request.receive())
    try:
        await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
        if not work.done():
            raise ClientDisconnect
        return work.result()
    finally:
        work.cancel()
        gone.cancel()
