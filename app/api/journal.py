"""Request ids, and one line in the log for each request."""

from __future__ import annotations

import logging
import os
import re
import sys
import time
from collections.abc import Mapping
from typing import Any, Literal

import structlog
from pydantic_core import to_json
from starlette._utils import get_route_path
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import problem_response

log = structlog.get_logger("tubeloom.http")

HEADER = "X-Request-ID"
_HEADER = HEADER.lower().encode()

_SANE = re.compile(r"[A-Za-z0-9._:-]{1,128}")

CLIENT_GONE = 499
"""What is logged where the client did not wait for the answer, as by nginx."""


def configure_logging(log_format: Literal["console", "json"]) -> None:
    """Write every event to standard error, other libraries' too, as lines for people or as JSON."""
    own: list[structlog.typing.Processor] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        structlog.processors.TimeStamper(fmt="iso", utc=True),
    ]
    last: list[structlog.typing.Processor] = (
        [structlog.processors.format_exc_info, structlog.processors.JSONRenderer(_json)]
        if log_format == "json"
        else [
            structlog.dev.ConsoleRenderer(
                colors=sys.stderr.isatty(), exception_formatter=structlog.dev.plain_traceback
            )
        ]
    )
    # Our own events do not take the way through the standard library, which is three times as long.
    structlog.configure(
        processors=[*own, *last],
        logger_factory=_NamedLogger,
        wrapper_class=structlog.make_filtering_bound_logger(logging.INFO),
        cache_logger_on_first_use=True,
    )
    handler = logging.StreamHandler()
    handler.setFormatter(
        structlog.stdlib.ProcessorFormatter(
            foreign_pre_chain=[*own, structlog.stdlib.ExtraAdder(allow=())],
            processors=[structlog.stdlib.ProcessorFormatter.remove_processors_meta, *last],
        )
    )
    logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)


class _NamedLogger(structlog.WriteLogger):
    """Writes to standard error, and knows its name."""

    def __init__(self, name: str = "tubeloom") -> None:
        super().__init__(sys.stderr)
        self.name = name


def _json(event: Mapping[str, Any], **_: Any) -> str:
    return to_json(event, fallback=repr).decode()


class Journal:
    """Middleware around everything: nothing escapes it, so every request is answered and logged."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        request_id = _request_id(scope)
        scope.setdefault("state", {})["request_id"] = request_id
        started = time.perf_counter()
        status, sent_bytes, answered = CLIENT_GONE, 0, 0.0

        async def note(message: Message) -> None:
            nonlocal status, sent_bytes, answered
            if message["type"] == "http.response.start":
                status, answered = message["status"], time.perf_counter()
                message["headers"] = [*message["headers"], (_HEADER, request_id.encode())]
            else:
                sent_bytes += len(message.get("body", b""))
            await send(message)

        with structlog.contextvars.bound_contextvars(request_id=request_id):
            try:
                await self.app(scope, receive, note)
            except ClientDisconnect:
                pass
            except Exception as error:
                log.exception("unexpected error")
                if status == CLIENT_GONE:
                    await problem_response(Request(scope), error)(scope, receive, note)
            finally:
                if held := scope["state"].get("held_bytes"):
                    scope["app"].state.held_bodies.release(held)
                ended = time.perf_counter()
                scope["app"].state.metrics.note_request(
                    scope["method"], get_route_path(scope), status, (answered or ended) - started
                )
                log.info(
                    "request",
                    method=scope["method"],
                    path=scope["path"],
                    status=status,
                    ms=round((ended - started) * 1000, 1),
                    bytes=sent_bytes,
                )


def _request_id(scope: Scope) -> str:
    for name, value in scope["headers"]:
        if name == _HEADER:
            given: str = value.decode("latin-1")
            if _SANE.fullmatch(given):
                return given
    return os.urandom(16).hex()
