"""An answer as server-sent events: how the work goes on, the picture as it comes, and the end.

Events are ``progress`` (stage, share), ``preview`` (a picture that is not finished), and at last
``answer`` (what a plain request would have got) or ``problem``.
"""

from __future__ import annotations

import asyncio
import base64
import json
from collections.abc import AsyncIterator, Iterator
from typing import Any, TypeAlias

import structlog
from fastapi.sse import format_sse_event
from starlette.requests import Request

from app.answers import Answer, Options
from app.api.event_streams import EventStream
from app.api.problems import problem_of
from app.api.responses import headers_of
from app.api.unread import SMALL_BYTES, Unread
from app.errors import TubeloomError
from app.jobs.answering import Answering
from app.jobs.executor import Finished
from app.jobs.recent import Recent
from app.jobs.work import Report

log = structlog.get_logger("tubeloom.http")

ENCODED_AT_ONCE = SMALL_BYTES // 4 * 3
"""Bytes of an answer, which as text are so few that they do not count beside the answer itself."""

SILENCE_SECONDS = 10.0
"""After which a comment says that there is still somebody here: proxies close what is silent."""


News: TypeAlias = tuple[Report, bytes] | None
"""A report and its preview, which may be empty; ``None``: the work is over."""


def event_response(
    request: Request, answering: Answering, document: bytes, options: Options, ending: str
) -> EventStream:
    """The answer that ``answering`` will have, as events; who leaves stops the work.

    Raises `Overloaded` where too many answers wait to be read already.
    """
    unread: Unread = request.app.state.unread
    unread.check()
    events = _events(request, answering, document, options, ending)
    return EventStream(events, {"Vary": "Accept"})


async def _events(
    request: Request, answering: Answering, document: bytes, options: Options, ending: str
) -> AsyncIterator[bytes]:
    heard: Recent[News] = Recent(large=_is_preview)
    work = asyncio.create_task(
        answering.answer(
            document, options, listener=lambda report, preview: heard.add((report, preview))
        )
    )
    work.add_done_callback(lambda _work: heard.add(None))
    try:
        while True:
            try:
                async with asyncio.timeout(SILENCE_SECONDS):
                    news = await heard.get()
            except TimeoutError:
                yield format_sse_event(comment="still at work")
                continue
            if news is None:
                break
            yield _news(*news)
        async for piece in _end(request, work, ending):
            yield piece
    finally:
        work.cancel()


def _is_preview(news: News) -> bool:
    return news is not None and news[1] != b""


def _news(report: Report, preview: bytes) -> bytes:
    if preview:
        return _event("preview", {"media_type": "image/png", "base64": _base64(preview)})
    return _event("progress", {"stage": report.stage, "share": round(report.share, 4)})


async def _end(request: Request, work: asyncio.Task[Finished], ending: str) -> AsyncIterator[bytes]:
    """The answer, piece by piece: a large one is not copied whole; or the problem."""
    unread: Unread = request.app.state.unread
    try:
        finished = work.result()
        with unread.holding(finished.pieces):
            for piece in _answer(finished, ending):
                yield piece
    except Exception as error:
        if not isinstance(error, TubeloomError):
            log.exception("unexpected error")
        yield _event("problem", problem_of(request, error))


def _answer(finished: Finished, ending: str) -> Iterator[bytes]:
    assert isinstance(finished.answer, Answer), "nothing is known, so nothing is unchanged"  # noqa: S101
    about = {"media_type": finished.answer.media_type, "headers": headers_of(finished, ending)}
    begun = json.dumps(about, ensure_ascii=False).removesuffix("}")
    yield f'event: answer\ndata: {begun}, "base64": "'.encode()
    rest = b""
    for piece in finished.pieces:
        for start in range(0, len(piece), ENCODED_AT_ONCE):
            data = rest + piece[start : start + ENCODED_AT_ONCE]
            whole = len(data) - len(data) % 3  # three bytes become four characters
            yield base64.b64encode(data[:whole])
            rest = data[whole:]
    yield base64.b64encode(rest) + b'"}\n\n'


def _event(name: str, data: dict[str, Any]) -> bytes:
    return format_sse_event(event=name, data_str=json.dumps(data, ensure_ascii=False))


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
