"""An answer as server-sent events: how the work goes on, the picture as it comes, and the end.

Events are ``progress`` (stage, share), ``preview`` (a picture that is not finished), and at last
``answer`` (what a plain request would have got) or ``problem``.
"""

from __future__ import annotations

import asyncio
import base64
import json
from collections.abc import AsyncIterator
from typing import Any, TypeAlias

import structlog
from fastapi.sse import format_sse_event
from starlette.requests import Request

from app.answers import Answer, Options
from app.api.event_streams import EventStream
from app.api.problems import problem_of
from app.api.responses import headers_of
from app.api.unread import Unread
from app.errors import TubeloomError
from app.jobs.answering import Answering
from app.jobs.recent import Recent
from app.jobs.work import Report

log = structlog.get_logger("tubeloom.http")

COPIES = 4
"""Of an answer that are in memory while it becomes an event, whose text is longer by a third."""

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
        yield _end(request, work, ending)
    finally:
        work.cancel()


def _is_preview(news: News) -> bool:
    return news is not None and news[1] != b""


def _news(report: Report, preview: bytes) -> bytes:
    if preview:
        return _event("preview", {"media_type": "image/png", "base64": _base64(preview)})
    return _event("progress", {"stage": report.stage, "share": round(report.share, 4)})


def _end(request: Request, work: asyncio.Task[Any], ending: str) -> bytes:
    try:
        finished = work.result()
        unread: Unread = request.app.state.unread
        unread.check(COPIES * sum(map(len, finished.pieces)))
    except Exception as error:
        if not isinstance(error, TubeloomError):
            log.exception("unexpected error")
        return _event("problem", problem_of(request, error))
    assert isinstance(finished.answer, Answer), "nothing is known, so nothing is unchanged"  # noqa: S101
    return _event(
        "answer",
        {
            "media_type": finished.answer.media_type,
            "headers": headers_of(finished, ending),
            "base64": _base64(b"".join(finished.pieces)),
        },
    )


def _event(name: str, data: dict[str, Any]) -> bytes:
    return format_sse_event(event=name, data_str=json.dumps(data, ensure_ascii=False))


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
