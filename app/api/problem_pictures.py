"""Problems as pictures, for pages that embed what we draw.

A thread of its own draws them, one at a time, and those drawn last are kept.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import Any

from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from app.api.problems import headers_of, problem_of, problem_response
from app.output.media import SceneFormat

DEFAULT_SIZE = 1024, 768

LONGEST_SIDE = 1024
"""In pixels. Who asks for more gets a picture of the same shape with sides as long as this."""

SHORTEST_SIDE = 100

MOST_LINES = 40
"""Of faults that a picture may name; there is room for fewer."""

LONGEST_LINE = 600
"""Characters of a fault in a picture."""

KEPT = 64
"""Pictures that are kept; one has some ten thousand bytes."""

MOST_WAITING = 8
"""Pictures that wait to be drawn; who asks for one more gets the problem as JSON."""


class ProblemPictures:
    """Draws problems beside the event loop."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, "problem pictures")
        self._draw = lru_cache(KEPT)(_drawn)
        self._waiting = 0

    async def picture(
        self, details: Mapping[str, Any], query: Mapping[str, str]
    ) -> tuple[bytes, str] | None:
        """A picture of the problem, and its media type: SVG, or else PNG.

        It is as large as was asked for, within bounds. ``None`` where too many wait for theirs.
        """
        if self._waiting >= MOST_WAITING:
            return None
        scene_format = SceneFormat.SVG if query.get("format") == "svg" else SceneFormat.PNG
        errors = details.get("errors", [])
        lines = [
            f"{error.get('pointer', error.get('parameter', ''))}: {error['detail']}"
            for error in errors[:MOST_LINES]
        ] or [details["detail"]]
        wanted = (
            details["title"],
            tuple(line[:LONGEST_LINE] for line in lines),
            len(errors) - MOST_LINES,
            *size_of(query),
            scene_format is SceneFormat.SVG,
        )
        self._waiting += 1
        try:
            loop = asyncio.get_running_loop()
            body = await loop.run_in_executor(self._thread, self._draw, *wanted)
        finally:
            self._waiting -= 1
        return body, scene_format.media_type

    def close(self) -> None:
        """Wait for the picture that is being drawn, and draw no more."""
        self._thread.shutdown(cancel_futures=True)


async def answer_problem(request: Request, error: Exception) -> Response:
    """The application's handler of exceptions: JSON, or the picture that was asked for.

    Keys and rates are asked for before; whoever may not ask at all gets no picture.
    """
    has_route = not isinstance(error, HTTPException)
    if has_route and b"errors=image" in request.scope.get("query_string", b""):
        pictures: ProblemPictures = request.app.state.problem_pictures
        details = problem_of(request, error)
        if (drawn := await pictures.picture(details, request.query_params)) is not None:
            body, media_type = drawn
            return Response(body, details["status"], headers_of(error), media_type)
    return problem_response(request, error)


def size_of(query: Mapping[str, str]) -> tuple[int, int]:
    """Width and height in pixels, within what is legible and quick to draw.

    >>> size_of({}), size_of({"width": "2048", "height": "1536"}), size_of({"width": "x"})
    ((1024, 768), (1024, 768), (1024, 768))
    """
    width, height = (
        _side(query.get(name), usual)
        for name, usual in zip(("width", "height"), DEFAULT_SIZE, strict=True)
    )
    share = min(LONGEST_SIDE / max(width, height), 1.0)
    return max(round(width * share), SHORTEST_SIDE), max(round(height * share), SHORTEST_SIDE)


def _side(asked: str | None, usual: int) -> int:
    """A side as it was asked for; the usual one where the query itself is wrong."""
    if asked is None or not asked.isdecimal() or len(asked) > 5:
        return usual
    return max(int(asked), SHORTEST_SIDE)


def _drawn(
    title: str, lines: tuple[str, ...], more: int, width: int, height: int, as_svg: bool
) -> bytes:
    from app.output.error_picture import error_picture

    told = [*lines, f"And {more} more faults."] if more > 0 else lines
    return error_picture(title, told, width, height, as_svg=as_svg)
