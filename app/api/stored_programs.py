"""Stored programs: put, got, changed, taken back, deleted."""

from __future__ import annotations

from functools import partial
from typing import Annotated

from fastapi import APIRouter
from fastapi import Path as PathParameter
from fastapi import Query as QueryParameters
from pydantic import Field
from starlette.requests import Request
from starlette.responses import Response

from app.answers import Edits, JsonPatch, MergePatch, Replacement, is_known
from app.api.bodies import read_document, source_of
from app.api.conditions import entity_tag, known_tags
from app.api.negotiation import media_type_of
from app.api.once import check_is_same, fingerprint_of, request_of
from app.api.preconditions import precondition
from app.api.problems import PatchTypeError
from app.api.queries import Flag, PostedQuery, Query, RevisionQuery
from app.api.responses import COMMON_HEADERS, PiecesResponse, content_disposition
from app.api.revision_model import (
    ListedModel,
    ProgramList,
    RevisionList,
    RevisionModel,
    tag_of,
)
from app.api.stored_schema import (
    JSON_PATCH,
    MERGE_PATCH,
    describe_change,
    describe_document,
    describe_list,
)
from app.api.unread import Unread
from app.errors import NotStored
from app.jobs.changing import Changer, Wanted, Wish
from app.settings import Settings
from app.store import programs
from app.store.database import Database
from app.store.records import Cause, Content, Record
from app.store.requests import Reply

router = APIRouter(prefix="/v1/programs", tags=["stored programs"])

ProgramId = Annotated[
    str,
    PathParameter(
        alias="id",
        pattern=r"^[A-Za-z0-9][A-Za-z0-9._~-]{0,199}$",
        description="Letters, digits and . _ ~ -, as whoever stores it likes.",
    ),
]

MOST_LISTED = 1000


class ListQuery(Query):
    """Which part of the list."""

    limit: int = Field(100, ge=1, le=MOST_LISTED)
    after: str | None = Field(
        None, pattern=r"^[A-Za-z0-9._~-]{0,200}$", description="The part that follows this id."
    )


class EditQuery(Query):
    """What may be asked of edits."""

    amend: Flag = Field(
        False,
        description="Whether they are one change to undo with the edits before, such as all steps "
        "of one drag. After anything else than edits they are a change of their own.",
    )


@router.get("", responses=describe_list())
async def list_programs(
    request: Request, query: Annotated[ListQuery, QueryParameters()]
) -> ProgramList:
    """The stored programs, in the order of their ids, a part at a time."""
    database: Database = request.app.state.database
    found = await database.read(partial(programs.listing, after=query.after, limit=query.limit + 1))
    page = found[: query.limit]
    return ProgramList(
        programs=tuple(map(ListedModel.of, page)),
        next=page[-1].id if len(found) > len(page) else None,
    )


@router.get("/{id}", **describe_document())
async def get_program(
    request: Request, program: ProgramId, query: Annotated[RevisionQuery, QueryParameters()]
) -> Response:
    """The document in canonical form: what equals its default is left out."""
    unread: Unread = request.app.state.unread
    unread.check()
    content = await content_of(request, program, query.revision)
    tag = tag_of(content.record)
    headers = {
        **COMMON_HEADERS,
        "ETag": entity_tag(tag),
        "Content-Disposition": content_disposition(content.record.name, "json"),
        "Tubeloom-Revision": str(content.record.number),
    }
    if is_known(tag, known_tags(request.headers.get("if-none-match"))):
        return Response(status_code=304, headers=headers)
    return PiecesResponse((content.document,), "application/json", headers)


@router.put("/{id}", **describe_change("put"))
async def put_program(
    request: Request, program: ProgramId, query: Annotated[PostedQuery, QueryParameters()]
) -> Response:
    """Store the posted document. What it has in common with the one before keeps its place."""
    body = await _body(request)
    return await _change(
        request, program, "put", Replacement(body, source_of(request, query)), body
    )


@router.patch("/{id}", **describe_change("patch"))
async def patch_program(request: Request, program: ProgramId) -> Response:
    """Change the document by JSON Patch (RFC 6902) or JSON Merge Patch (RFC 7396)."""
    media_type = media_type_of(request.headers.get("content-type", ""))
    if media_type not in {JSON_PATCH, MERGE_PATCH}:
        raise PatchTypeError(f"Send a patch as {JSON_PATCH} or {MERGE_PATCH}.")
    body = await _body(request)
    patch = JsonPatch(body) if media_type == JSON_PATCH else MergePatch(body)
    return await _change(request, program, "patch", patch, body)


@router.post("/{id}/edits", **describe_change("edits"))
async def edit_program(
    request: Request, program: ProgramId, query: Annotated[EditQuery, QueryParameters()]
) -> Response:
    """Change the program by edits that say what they mean: all of them are done, or none."""
    body = await _body(request)
    return await _change(request, program, "edit", Edits(body), body, amends=query.amend)


@router.post("/{id}/undo", **describe_change("undo"))
async def undo(request: Request, program: ProgramId) -> Response:
    """Take the last change back: document and layout are as before, to the last byte."""
    return await _change(request, program, "undo", "undo", b"")


@router.post("/{id}/redo", **describe_change("redo"))
async def redo(request: Request, program: ProgramId) -> Response:
    """Make the change again that was taken back last."""
    return await _change(request, program, "redo", "redo", b"")


@router.delete("/{id}", **describe_change("delete"))
async def delete_program(request: Request, program: ProgramId) -> Response:
    """Delete a program with all its revisions."""
    return await _change(request, program, "delete", "delete", b"")


@router.get("/{id}/revisions", responses=describe_list(404))
async def list_revisions(request: Request, program: ProgramId) -> RevisionList:
    """The revisions that are kept, the newest first."""
    database: Database = request.app.state.database
    found = await database.read(partial(programs.kept_after, program=program, number=0))
    if not found or found[-1].cause == "delete":
        raise _unknown(program)
    return RevisionList(revisions=tuple(map(RevisionModel.of, reversed(found))))


async def content_of(request: Request, program: str, revision: int | None) -> Content:
    """A revision of a stored program (``None``: the newest). Raises `NotStored`."""
    database: Database = request.app.state.database
    content = await database.read(partial(programs.load, program=program, number=revision))
    if content is None:
        raise _unknown(program, revision)
    return content


async def _body(request: Request) -> bytes:
    settings: Settings = request.app.state.settings
    return await read_document(request, settings.max_body_bytes)


async def _change(
    request: Request,
    program: str,
    cause: Cause,
    wanted: Wanted,
    body: bytes,
    *,
    amends: bool = False,
) -> Response:
    changer: Changer = request.app.state.changer
    fingerprint = fingerprint_of(request, body)
    wish = Wish(
        program,
        wanted,
        cause,
        precondition(request),
        partial(_reply, request.url.path, fingerprint),
        request_of(request),
        amends,
    )
    reply = await changer.change(wish)
    check_is_same(reply, fingerprint)
    return Response(reply.body, reply.status, dict(reply.headers))


def _reply(path: str, fingerprint: str, record: Record, is_new: bool) -> Reply:
    if record.cause == "delete":
        return Reply(fingerprint, 204, {}, b"")
    headers = {
        "Content-Type": "application/json",
        "ETag": entity_tag(tag_of(record)),
        "Tubeloom-Revision": str(record.number),
        "Cache-Control": "no-store",
    }
    body = RevisionModel.of(record).model_dump_json().encode()
    if is_new:
        return Reply(fingerprint, 201, {**headers, "Location": path}, body)
    return Reply(fingerprint, 200, headers, body)


def _unknown(program: str, revision: int | None = None) -> NotStored:
    if revision is None:
        return NotStored(f"There is no program {program}.")
    return NotStored(f"There is no revision {revision} of a program {program} (any more).")
