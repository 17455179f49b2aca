"""Asking for answers for somebody who may leave before they answer."""

from __future__ import annotations

import asyncio

from starlette.requests import ClientDisconnect, Request

from app.answers import Options
from app.api.conditions import known_tags
from app.api.unread import Unread
from app.jobs.answering import Answering
from app.jobs.executor import Finished


async def ask(
    request: Request, document: bytes, options: Options, layout: bytes | None = None
) -> Finished:
    """The answer to a request whose body has been read.

    Raises what the workers raise, `Overloaded` where too many answers wait to be read already, and
    `ClientDisconnect`, which stops the work, when nobody waits for the answer any more.
    """
    unread: Unread = request.app.state.unread
    unread.check()
    answering: Answering = request.app.state.answering
    known = known_tags(request.headers.get("if-none-match"))
    if (finished := answering.at_hand(document, options, known, layout)) is not None:
        return finished
    work = asyncio.create_task(answering.answer(document, options, known, layout=layout))
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
