"""The calls that take a document: render, layout, convert."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from fastapi import APIRouter
from fastapi import Query as QueryParameters
from starlette.requests import Request
from starlette.responses import Response

from app.answers import ConvertOptions, LayoutOptions, Options
from app.api import events
from app.api.asking import ask
from app.api.bodies import read_document, source_of
from app.api.event_streams import MEDIA_TYPE
from app.api.job_schema import or_job
from app.api.negotiation import choose, names, without
from app.api.prefer import preferences
from app.api.queries import ConvertQuery, LayoutQuery, RenderQuery
from app.api.quick_routes import QuickRoute
from app.api.responses import response_of
from app.api.scene_queries import render_options, scene_format
from app.api.schema import describe
from app.api.starting import start_if_long
from app.formats.registry import FORMATS
from app.jobs.answering import Answering
from app.settings import Settings

router = APIRouter(
    prefix="/v1", tags=["programs"], default_response_class=Response, route_class=QuickRoute
)

NUMBERS: Mapping[str, str] = {"application/json": "json"}


@router.post("/render", **or_job(describe("render")))
async def render(request: Request, query: Annotated[RenderQuery, QueryParameters()]) -> Response:
    """The scene of the posted program, as glTF, as a picture or a film, or for a printer.

    Without `format`, `Accept` decides; without both it is `model/gltf-binary`. Where `Accept` names
    `text/event-stream` too, the answer comes as the last of server-sent events that tell how the
    work goes on: `progress`, `preview`, `answer`, `problem`. With `Prefer: respond-async`, what
    would take longer than a request may (or than `wait=` says, in seconds) becomes a job.
    """
    accept = request.headers.get("accept")
    wanted = scene_format(query, without(MEDIA_TYPE, accept))
    options = render_options(query, wanted, source_of(request, query), query.wishes)
    if names(MEDIA_TYPE, accept):
        document = await read_document(request, request.app.state.settings.max_body_bytes)
        answering: Answering = request.app.state.answering
        return events.event_response(request, answering, document, options, options.format.value)
    preferred = preferences(request.headers.getlist("prefer"))
    if preferred.respond_async:
        document = await read_document(request, request.app.state.settings.max_body_bytes)
        started = await start_if_long(request, document, options, preferred)
        return started or response_of(await ask(request, document, options), options.format.value)
    return await _answer(request, options, options.format.value)


@router.post("/layout", **describe("layout"))
async def layout(request: Request, query: Annotated[LayoutQuery, QueryParameters()]) -> Response:
    """The numbers: where items stand, and the control points of every hyperedge's curves."""
    ending = choose(request.headers.get("accept"), NUMBERS)
    options = LayoutOptions(query.patches, source_of(request, query), query.wishes)
    return await _answer(request, options, ending)


@router.post("/convert", **describe("convert"))
async def convert(request: Request, query: Annotated[ConvertQuery, QueryParameters()]) -> Response:
    """The posted document in another format."""
    ending = choose(request.headers.get("accept"), {FORMATS[query.target].media_type: "json"})
    return await _answer(request, ConvertOptions(source_of(request, query), query.target), ending)


async def _answer(request: Request, options: Options, ending: str) -> Response:
    settings: Settings = request.app.state.settings
    document = await read_document(request, settings.max_body_bytes)
    return response_of(await ask(request, document, options), ending)
