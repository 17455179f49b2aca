"""The pages for browsers, as they were built, and the viewer element for pages of others."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter
from starlette.exceptions import HTTPException
from starlette.responses import FileResponse, Response
from starlette.routing import Mount
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

router = APIRouter(include_in_schema=False)

BUILT = Path(__file__).parents[1] / "web" / "built"

MISSING = "The pages are not built; `make web` builds them. The interface is described at /docs."

REVALIDATED = {"Cache-Control": "no-cache"}
"""For files whose names stay while their contents change."""

NEVER_CHANGES = "public, max-age=31536000, immutable"
"""For files that are named by their contents."""


@router.get("/")
async def playground() -> Response:
    """A program on the left, its picture on the right."""
    return _file("index.html")


@router.get("/viewer")
async def viewer() -> Response:
    """A stored program's picture, live, or that of a file."""
    return _file("viewer.html")


@router.get("/editor")
async def editor() -> Response:
    """A node editor with its program in three dimensions beside it."""
    return _file("editor.html")


@router.get("/litegraph")
async def litegraph() -> Response:
    """Another editor, connected by the same three calls."""
    return _file("litegraph.html")


@router.get("/tube-viewer.js")
async def element() -> Response:
    """The element, for pages of one's own."""
    return _file("tube-viewer.js")


def _file(name: str) -> Response:
    if not (BUILT / name).is_file():
        raise HTTPException(404, MISSING)
    return FileResponse(BUILT / name, headers=REVALIDATED)


class _NamedByContents(StaticFiles):
    async def get_response(self, path: str, scope: Scope) -> Response:
        response = await super().get_response(path, scope)
        response.headers["Cache-Control"] = NEVER_CHANGES
        return response


def assets() -> Mount:
    """What the pages load."""
    return Mount("/web", _NamedByContents(directory=BUILT / "web", check_dir=False))
