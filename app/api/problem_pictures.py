"""Problems as pictures, for pages that embed what we draw."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from app.output.media import SceneFormat

DEFAULT_SIZE = 1024, 768


def problem_picture(details: Mapping[str, Any], query: Mapping[str, str]) -> tuple[bytes, str]:
    """A picture of the problem as large as was asked for, and its media type: SVG, or else PNG."""
    from app.output.error_picture import error_picture

    scene_format = SceneFormat.SVG if query.get("format") == "svg" else SceneFormat.PNG
    lines = [
        f"{error.get('pointer', error.get('parameter', ''))}: {error['detail']}"
        for error in details.get("errors", [])
    ] or [details["detail"]]
    width, height = (
        _side(query.get(name), usual)
        for name, usual in zip(("width", "height"), DEFAULT_SIZE, strict=True)
    )
    body = error_picture(
        details["title"], lines, width, height, as_svg=scene_format is SceneFormat.SVG
    )
    return body, scene_format.media_type


def _side(asked: str | None, usual: int) -> int:
    """Within what is legible and quick to draw: the query may be what is wrong."""
    if asked is None or not asked.isdecimal() or len(asked) > 5:
        return usual
    return min(max(int(asked), 100), 2048)
