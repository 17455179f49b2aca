"""The least that a service can do: read the body, and answer so many bytes.

Run as ``python -m benchmarks.bare_service starlette|fastapi BYTES``, with the server's settings
that Tubeloom has.
"""

from __future__ import annotations

import logging
import os
import sys
from typing import Any

import uvicorn
from fastapi import FastAPI
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route


def app_of(kind: str, size: int) -> Any:
    """An application of that kind whose answers have that size."""
    body = os.urandom(size)  # a page of zeros would be quicker to send than any real answer

    async def answer(request: Request) -> Response:
        await request.body()
        return Response(body, media_type="model/gltf-binary")

    if kind == "starlette":
        return Starlette(routes=[Route("/v1/render", answer, methods=["POST"])])
    app = FastAPI()
    app.post("/v1/render")(answer)
    return app


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO)
    uvicorn.run(
        app_of(sys.argv[1], int(sys.argv[2])),
        port=0,
        log_config=None,
        access_log=False,
        server_header=False,
    )
