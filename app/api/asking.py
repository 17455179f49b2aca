"""Asking the workers for somebody who may leave before they answer."""

from __future__ import annotations

import asyncio

from starlette.requests import ClientDisconnect, Request

from app.answers import Options
from app.api.conditions import known_tags
from app.jobs.executor import Finished, WorkerPool


async def ask(
    request: Request, document: bytes, options: Options, layout: bytes | None = None
) -> Finished:
    """The workers' answer to a request whose body has been read.

    Raises what the workers raise, and `ClientDisconnect`, which stops them, when nobody waits for
    the answer any more.
    """
    pool: WorkerPool = request.app.state.pool
    known = known_tags(request.headers.get("if-none-match"))
    work = asyncio.create_task(pool.answer(document, options, known, layout=layout))
    # The body has been read, so the only message that can still come is the disconnection.
    gone = asyncio.ensure_future(request.receive())
    try:
        await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
        if not work.done():
            raise ClientDisconnect
        return work.result()
    finally:
        work.cancel()
        gone.cancel()
