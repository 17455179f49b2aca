"""Every call as plain data: what to send, and how to read the answer. Nothing here waits."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from urllib.parse import quote

import httpx

from tubeloom_client.decoding import decode
from tubeloom_client.layouts import Layout
from tubeloom_client.options import Document, Format, Query, RenderOptions, body_of, query_of
from tubeloom_client.problems import problem_of
from tubeloom_client.records import Changed, JobState, Page, Revision, Stored

Answer = TypeVar("Answer")

JSON = {"Content-Type": "application/json"}


@dataclass(frozen=True, slots=True)
class Call(Generic[Answer]):
    """A request, and what its answer is to the caller."""

    method: str
    path: str
    read: Callable[[httpx.Response], Answer]
    query: Query = field(default_factory=list)
    headers: Mapping[str, str] = field(default_factory=dict)
    body: bytes | None = None

    def request(self, client: httpx.Client) -> httpx.Request:
        """The request, as ``client`` sends it."""
        return client.build_request(
            self.method, self.path, params=self.query, headers=self.headers, content=self.body
        )

    def answer(self, response: httpx.Response) -> Answer:
        """What ``response`` is to the caller. Raises `Problem`."""
        if response.is_error:
            raise problem_of(response)
        return self.read(response)


def render(
    document: Document, source: str | None, wanted: Format, options: RenderOptions
) -> Call[bytes]:
    """The scene of a document."""
    query = query_of(from_=source, format=wanted, **options)
    return Call("POST", "/v1/render", _bytes, query, JSON, body_of(document))


def layout(document: Document, source: str | None, patches: bool) -> Call[Layout]:
    """The numbers of a document's layout."""
    query = query_of(from_=source, patches=patches)
    return Call("POST", "/v1/layout", _layout, query, JSON, body_of(document))


def convert(document: Document, source: str | None, target: str) -> Call[Any]:
    """A document in another format."""
    query = query_of(from_=source, to=target)
    return Call("POST", "/v1/convert", _json, query, JSON, body_of(document))


def catalogue(name: str) -> Call[Any]:
    """What there is: notations, materials, palettes or formats."""
    return Call("GET", f"/v1/{name}", _json)


def programs(after: str | None) -> Call[Page]:
    """Some of the stored programs, those that follow ``after``."""
    return Call("GET", "/v1/programs", _page, query_of(after=after))


def get(program: str, revision: int | None) -> Call[Stored]:
    """A stored program's document."""
    return Call("GET", _program(program), _stored, query_of(revision=revision))


def put(
    program: str, document: Document, source: str | None, etag: str | None, only_new: bool
) -> Call[Changed]:
    """Store a document."""
    condition = {"If-None-Match": "*"} if only_new else _if_match(etag)
    headers = {**JSON, **condition, **_once()}
    query = query_of(from_=source)
    return Call("PUT", _program(program), _changed, query, headers, body_of(document))


def edit(
    program: str, edits: Sequence[Mapping[str, Any]], etag: str | None, amend: bool
) -> Call[Changed]:
    """Carry out edits, all or none."""
    headers = {**JSON, **_if_match(etag), **_once()}
    body = body_of({"edits": list(edits)})
    query = query_of(amend=amend or None)
    return Call("POST", _program(program, "edits"), _changed, query, headers, body)


def patch(
    program: str, change: Mapping[str, Any] | Sequence[Mapping[str, Any]], etag: str | None
) -> Call[Changed]:
    """Change a document by a JSON Merge Patch (a mapping) or a JSON Patch (a sequence)."""
    is_merge = isinstance(change, Mapping)
    kind = "application/merge-patch+json" if is_merge else "application/json-patch+json"
    headers = {"Content-Type": kind, **_if_match(etag), **_once()}
    body = body_of(change) if isinstance(change, Mapping) else body_of(list(change))
    return Call("PATCH", _program(program), _changed, [], headers, body)


def step(program: str, way: str, etag: str | None) -> Call[Changed]:
    """Undo or redo."""
    return Call("POST", _program(program, way), _changed, [], {**_if_match(etag), **_once()})


def delete(program: str, etag: str | None) -> Call[None]:
    """Remove a program."""
    return Call("DELETE", _program(program), _nothing, [], {**_if_match(etag), **_once()})


def revisions(program: str) -> Call[tuple[Revision, ...]]:
    """The revisions that are kept."""
    return Call("GET", _program(program, "revisions"), _revisions)


def render_stored(
    program: str, wanted: Format, since: int | None, revision: int | None, options: RenderOptions
) -> Call[bytes]:
    """The scene of a stored program."""
    query = query_of(format=wanted, since=since, revision=revision, **options)
    return Call("GET", _program(program, "render"), _bytes, query)


def layout_stored(program: str, patches: bool, revision: int | None) -> Call[Layout]:
    """The numbers of a stored program's layout."""
    query = query_of(patches=patches, revision=revision)
    return Call("GET", _program(program, "layout"), _layout, query)


def watched(program: str) -> str:
    """Where the events of a program are."""
    return _program(program, "events")


def start(
    document: Document, source: str | None, wanted: Format, options: RenderOptions
) -> Call[JobState]:
    """Make a job of a render."""
    query = query_of(from_=source, format=wanted, **options)
    return Call("POST", "/v1/jobs", _job, query, {**JSON, **_once()}, body_of(document))


def start_stored(
    program: str, wanted: Format, revision: int | None, options: RenderOptions
) -> Call[JobState]:
    """Make a job of a render of a stored program."""
    query = query_of(program=program, format=wanted, revision=revision, **options)
    return Call("POST", "/v1/jobs", _job, query, _once())


def job(identifier: str) -> Call[JobState]:
    """How a job goes on."""
    return Call("GET", _job_path(identifier), _job)


def result(identifier: str) -> Call[bytes]:
    """What a job has made."""
    return Call("GET", _job_path(identifier, "result"), _bytes)


def cancel(identifier: str) -> Call[None]:
    """End a job."""
    return Call("DELETE", _job_path(identifier), _nothing)


def followed(identifier: str) -> str:
    """Where the events of a job are."""
    return _job_path(identifier, "events")


def _program(program: str, *parts: str) -> str:
    return "/".join(["/v1/programs", quote(program, safe=""), *parts])


def _job_path(identifier: str, *parts: str) -> str:
    return "/".join(["/v1/jobs", quote(identifier, safe=""), *parts])


def _if_match(etag: str | None) -> dict[str, str]:
    return {} if etag is None else {"If-Match": etag}


def _once() -> dict[str, str]:
    """So that a call whose answer got lost can be sent again without being done twice."""
    return {"Idempotency-Key": str(uuid.uuid4())}


def _nothing(_response: httpx.Response) -> None:
    return None


def _bytes(response: httpx.Response) -> bytes:
    return response.content


def _json(response: httpx.Response) -> Any:
    return response.json()


def _layout(response: httpx.Response) -> Layout:
    return decode(Layout, response.json())


def _page(response: httpx.Response) -> Page:
    return decode(Page, response.json())


def _stored(response: httpx.Response) -> Stored:
    return Stored(response.json(), response.headers["etag"])


def _changed(response: httpx.Response) -> Changed:
    return Changed(decode(Revision, response.json()), response.headers["etag"])


def _revisions(response: httpx.Response) -> tuple[Revision, ...]:
    return tuple(decode(Revision, each) for each in response.json()["revisions"])


def _job(response: httpx.Response) -> JobState:
    return decode(JobState, response.json())
