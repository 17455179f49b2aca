"""The application: HTTP in front of a pool of worker processes."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager

from fastapi import FastAPI
from starlette.exceptions import HTTPException
from starlette.middleware.cors import CORSMiddleware

from app import __version__
from app.api import (
    catalogue,
    docs,
    health,
    jobs,
    metrics,
    pages,
    programs,
    schema,
    stored_programs,
    stored_views,
)
from app.api.accounts import accountant
from app.api.bodies import HeldBodies
from app.api.cross_origin import EXPOSED_HEADERS, HEADERS, METHODS
from app.api.defences import Defences
from app.api.event_streams import EventStreams
from app.api.feed import Feed
from app.api.guard import Guard
from app.api.journal import Journal
from app.api.keyring import Keyring
from app.api.metrics import Metrics
from app.api.problem_pictures import ProblemPictures, answer_problem
from app.api.problems import KINDS
from app.api.tracing import OFF, tracing_of
from app.api.unread import Unread, UnreadAnswers
from app.jobs.answering import Answering
from app.jobs.changing import Changer
from app.jobs.crew import crew_of
from app.jobs.desk import Desk
from app.jobs.executor import WorkerPool
from app.jobs.keeper import Keeper
from app.jobs.launch import Launched
from app.settings import Settings
from app.settings import settings as settings_of_process
from app.store.database import Database
from app.store.results import Results

DESCRIPTION = """
Lays out the hyperedges of a posted program as smooth tubes in three dimensions.

```
curl --data-binary @program.json 'http://127.0.0.1:8000/v1/render?format=png' -o program.png
```
"""


ROUTED = (programs, jobs, stored_programs, stored_views, catalogue, health, metrics, docs, pages)
"""Modules with routes, in the order in which the interface's description shows them."""


def create_app(settings: Settings | None = None, launched: list[Launched] | None = None) -> FastAPI:
    """The application, with the ``settings`` given or those of the environment.

    Its workers are those processes that are ``launched`` already, as far as they go.
    """
    chosen = settings or settings_of_process()
    tracing = tracing_of(chosen)

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            if tracing is not None:
                stack.push_async_callback(asyncio.to_thread, tracing.close)
            stack.push_async_callback(asyncio.to_thread, app.state.problem_pictures.close)
            database = Database(chosen.database_url)
            stack.push_async_callback(asyncio.to_thread, database.close)
            await asyncio.to_thread(database.migrate)
            pool = await stack.enter_async_context(WorkerPool(chosen, launched=launched))
            pool.witness = accountant(app.state.metrics, tracing)
            app.state.metrics.watch(pool, chosen.workers)
            results = await stack.enter_async_context(
                Results(chosen.results_place, database, chosen.results_bytes)
            )
            app.state.results = results
            app.state.answering = await stack.enter_async_context(Answering(pool, results, chosen))
            crew = await stack.enter_async_context(crew_of(chosen, pool.witness))
            keeper = await stack.enter_async_context(Keeper(chosen, database, results, crew))
            app.state.desk = Desk(chosen, database, results, keeper)
            feed = await stack.enter_async_context(Feed(database, chosen))
            changer = Changer(database, pool, chosen)
            changer.listener = feed.tell
            app.state.database = database
            app.state.keyring = Keyring(database, chosen.key_seconds)
            app.state.pool = pool
            app.state.examiner = health.Examiner(pool, database, chosen.examine_seconds)
            app.state.feed, app.state.changer = feed, changer
            app.state.before_shutdown = [feed.end, keeper.listeners.end]
            yield

    app = FastAPI(
        title="Tubeloom",
        version=__version__,
        summary="Relations that join many things at once, as smooth tubes in three dimensions.",
        description=DESCRIPTION,
        license_info={"name": "MIT", "identifier": "MIT"},
        lifespan=lifespan,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        exception_handlers=dict.fromkeys([*KINDS, HTTPException], answer_problem),
        telemetry=tracing.config if tracing else OFF,
    )
    app.state.settings = chosen
    app.state.held_bodies, app.state.metrics = HeldBodies(chosen.max_held_bytes), Metrics()
    app.state.unread = Unread(chosen.max_unread_bytes)
    app.state.event_streams = EventStreams(chosen.max_watchers)
    app.state.problem_pictures = ProblemPictures()
    app.add_middleware(UnreadAnswers, unread=app.state.unread)
    _protect(app, chosen)
    app.add_middleware(Journal)
    for part in ROUTED:
        # To include the router would have each request look for its route three times over.
        app.router.routes.extend(part.router.routes)
    app.router.routes += [docs.assets(), pages.assets()]
    app.openapi = lambda: schema.openapi(app)  # type: ignore[method-assign]  # FastAPI's own way
    return app


def _protect(app: FastAPI, settings: Settings) -> None:
    """Put before the routes what the settings ask for; what is added last stands outermost."""
    if settings.needs_keys or settings.rate_per_address or settings.budget_seconds:
        app.add_middleware(Guard, settings=settings)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=METHODS,
            allow_headers=HEADERS,
            expose_headers=EXPOSED_HEADERS,
        )
    app.add_middleware(Defences, settings=settings)
