"""Stored programs to look at: scenes, what changed in them, numbers, other formats, events."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import partial
from typing import Annotated

from fastapi import APIRouter
from fastapi import Query as QueryParameters
from pydantic import Field
from starlette.requests import Request
from starlette.responses import Response

from app.answers import ConvertOptions, Delta, LayoutOptions, Options
from app.api.asking import ask
from app.api.bodies import pass_over_body
from app.api.event_streams import EventStream
from app.api.feed import Feed
from app.api.negotiation import choose
from app.api.problems import ContradictionError
from app.api.queries import Query, StoredConvertQuery, StoredNumbersQuery, StoredSceneQuery
from app.api.responses import response_of
from app.api.scene_queries import render_options, scene_format
from app.api.stored_programs import ProgramId, content_of
from app.api.stored_schema import describe_events, describe_view
from app.formats.registry import FORMATS
from app.program.changes import combined
from app.store import programs
from app.store.database import Database
from app.store.records import Content

router = APIRouter(prefix="/v1/programs", tags=["stored programs"], default_response_class=Response)

LAST_EVENT_ID = "Last-Event-ID"


@router.get("/{id}/render", **describe_view("render"))
async def render_program(
    request: Request, program: ProgramId, query: Annotated[StoredSceneQuery, QueryParameters()]
) -> Response:
    """The scene of a stored program, as `POST /v1/render` answers, or what changed in it."""
    wanted = scene_format(query, request.headers.get("accept"))
    options = render_options(query, wanted, "tubeloom")
    if query.since is not None and not wanted.is_gltf:
        raise ContradictionError(
            "Only glTF can show what changed: leave out since, or ask for glb."
        )
    content = await content_of(request, program, query.revision)
    delta = None
    if query.since is not None:
        delta = await _delta(request, content, query.since)
        options = replace(options, delta=delta)
    response = await _view(request, content, options, wanted.value)
    if delta is not None:
        response.headers["Tubeloom-Since"] = str(delta.since)
    return response


@router.get("/{id}/layout", **describe_view("layout"))
async def lay_out_program(
    request: Request, program: ProgramId, query: Annotated[StoredNumbersQuery, QueryParameters()]
) -> Response:
    """The numbers of a stored program, as `POST /v1/layout` answers."""
    choose(request.headers.get("accept"), {"application/json": "json"})
    content = await content_of(request, program, query.revision)
    return await _view(request, content, LayoutOptions(query.patches), "json")


@router.get("/{id}/convert", **describe_view("convert"))
async def convert_program(
    request: Request, program: ProgramId, query: Annotated[StoredConvertQuery, QueryParameters()]
) -> Response:
    """A stored program in another format."""
    choose(request.headers.get("accept"), {FORMATS[query.target].media_type: "json"})
    content = await content_of(request, program, query.revision)
    return await _view(request, content, ConvertOptions("tubeloom", query.target), "json")


class EventsQuery(Query):
    """From where on events are told."""

    after: int | None = Field(
        None,
        ge=0,
        lt=2**31,
        description="The revision after which to begin; left out, and without `Last-Event-ID`, "
        "the newest.",
    )


@router.get("/{id}/events", **describe_events())
async def watch_program(
    request: Request, program: ProgramId, query: Annotated[EventsQuery, QueryParameters()]
) -> Response:
    """Each revision as it is made: `current` at first, then `revision`, at last `deleted`.

    Whoever comes back with `Last-Event-ID`, as browsers do by themselves, misses none; where
    some are not kept any more, `reset` says that the program is to be loaded anew.
    """
    feed: Feed = request.app.state.feed
    last = request.headers.get(LAST_EVENT_ID, "")
    after = int(last) if re.fullmatch(r"\d{1,9}", last) else query.after
    events = await feed.watch(program, after)
    return EventStream(
        events,
        {"X-Accel-Buffering": "no"},
    )


async def _view(request: Request, content: Content, options: Options, ending: str) -> Response:
    await pass_over_body(request)
    finished = await ask(request, content.document, options, content.layout)
    response = response_of(finished, ending)
    response.headers["Tubeloom-Revision"] = str(content.record.number)
    return response


async def _delta(request: Request, content: Content, since: int) -> Delta | None:
    """What changed between two revisions; ``None`` where all must be shown anew.

    Raises `ContradictionError` where ``since`` is yet to come.
    """
    record = content.record
    if since > record.number:
        raise ContradictionError(f"Revision {since} is yet to come: this is {record.number}.")
    database: Database = request.app.state.database
    kept = await database.read(partial(programs.kept_after, program=record.program, number=since))
    later = [each for each in kept if each.number <= record.number]
    changes = combined([each.changes for each in later])
    if changes.whole or len(later) < record.number - since:
        return None
    return Delta(
        since,
        record.number,
        changes.items.present,
        changes.hyperedges.present,
        changes.items.removed,
        changes.hyperedges.removed,
    )
