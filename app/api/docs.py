"""The interface's documentation as a page; nothing on it comes from the network."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from fastapi import APIRouter
from fastapi.openapi.docs import get_swagger_ui_html
from starlette.requests import Request
from starlette.responses import HTMLResponse
from starlette.routing import Mount
from starlette.staticfiles import StaticFiles

router = APIRouter(include_in_schema=False)

POLICY = (
    "default-src 'self'; img-src 'self' data:; script-src 'self' 'unsafe-inline'; "
    "style-src 'self' 'unsafe-inline'"
)
"""Holds the page to what we serve ourselves; Swagger UI starts from a script within the page."""

ICON = "data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg'/>"


@router.get("/docs")
async def docs(request: Request) -> HTMLResponse:
    """Swagger UI."""
    root = request.scope.get("root_path", "").rstrip("/")
    page = get_swagger_ui_html(
        openapi_url=f"{root}/openapi.json",
        title="Tubeloom",
        swagger_js_url=f"{root}/docs/assets/swagger-ui-bundle.js",
        swagger_css_url=f"{root}/docs/assets/swagger-ui.css",
        swagger_favicon_url=ICON,
        # Swagger UI would show a badge that a service of its makers draws.
        swagger_ui_parameters={"validatorUrl": None, "tryItOutEnabled": True},
    )
    page.headers["Content-Security-Policy"] = POLICY
    return page


def assets() -> Mount:
    """Swagger UI's own files, as an installed package carries them."""
    folder = Path(str(files("fastapi_standalone_docs"))) / "static" / "swagger"
    return Mount("/docs/assets", StaticFiles(directory=folder))
