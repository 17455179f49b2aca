"""Figures of the service for Prometheus: ``GET /metrics``.

Labels take a few values only, whatever is asked: routes as the table of scopes writes them, known
methods, statuses, and names of stages that the pipeline has.
"""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterable, Mapping, Sequence

from fastapi import APIRouter
from prometheus_client import (
    CollectorRegistry,
    Counter,
    Histogram,
    ProcessCollector,
    Summary,
    generate_latest,
)
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.registry import Collector
from starlette.requests import Request
from starlette.responses import Response

from app.api.scopes import TABLE, ScopeTable
from app.errors import StoreUnavailable
from app.jobs.answering import Answering
from app.jobs.executor import WorkerPool
from app.jobs.work import Stage
from app.store import jobs
from app.store.database import Database

router = APIRouter(include_in_schema=False)

MEDIA_TYPE = "text/plain; version=0.0.4; charset=utf-8"

SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
"""Bounds of histograms: from an answer that is known already to the longest work."""

PATIENCE_SECONDS = 2.0
"""Prometheus waits for ten; what the database does not tell by then is left out."""

METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})

OTHER = "other"
"""Stands for every route and method that there is not."""

MOST_STAGES = 100
"""Names of stages that are counted; the pipeline has some thirty."""

_STAGE_NAME = re.compile(r"[a-z][a-z0-9 -]{0,39}")


class Metrics:
    """What is counted, each service for itself."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        ProcessCollector(registry=self.registry)
        self._table = ScopeTable(TABLE)
        self._stage_names: set[str] = set()
        self._requests = Counter(
            "tubeloom_requests",
            "Requests that were answered; status 499: the client did not wait.",
            ["method", "route", "status"],
            registry=self.registry,
        )
        self._seconds = Histogram(
            "tubeloom_request_seconds",
            "From a request to the beginning of its answer.",
            ["method", "route"],
            buckets=SECONDS,
            registry=self.registry,
        )
        self._work = Histogram(
            "tubeloom_work_seconds",
            "Of a worker, for one answer.",
            buckets=SECONDS,
            registry=self.registry,
        )
        self._stages = Summary(
            "tubeloom_stage_seconds",
            "Of a worker, by what it was doing.",
            ["stage"],
            registry=self.registry,
        )

    def watch(self, pool: WorkerPool, wanted: int) -> None:
        """Show how ``pool`` does, of which ``wanted`` workers are wanted."""
        self.registry.register(_OfPool(pool, wanted))

    def note_request(self, method: str, path: str, status: int, seconds: float) -> None:
        """Count a request, ``seconds`` after which its answer began."""
        method = method if method in METHODS else OTHER
        route = self._table.template(path) or OTHER
        self._requests.labels(method, route, str(status)).inc()
        self._seconds.labels(method, route).observe(seconds)

    def note_work(self, seconds: float, stages: Sequence[Stage]) -> None:
        """Count a worker's work of so many ``seconds``, and its ``stages``."""
        self._work.observe(seconds)
        for stage in stages:
            self._stages.labels(self._stage_name(stage.name)).observe(stage.seconds)

    def text(self, answering: Answering, viewers: int, jobs: Mapping[str, int]) -> bytes:
        """Everything, as Prometheus reads it; also what ``answering`` has counted.

        ``viewers`` follow events of programs and jobs; of ``jobs`` there are so many by state.
        """
        more = CollectorRegistry()
        more.register(_Present(answering, viewers, jobs))
        return generate_latest(self.registry) + generate_latest(more)

    def _stage_name(self, name: str) -> str:
        if name not in self._stage_names:
            if len(self._stage_names) >= MOST_STAGES or not _STAGE_NAME.fullmatch(name):
                return OTHER
            self._stage_names.add(name)
        return name


class _OfPool(Collector):
    def __init__(self, pool: WorkerPool, wanted: int) -> None:
        self._pool, self._wanted = pool, wanted

    def collect(self) -> Iterable[Metric]:
        pool = self._pool
        workers = GaugeMetricFamily("tubeloom_workers", "Worker processes.", labels=["state"])
        workers.add_metric(["wanted"], self._wanted)
        workers.add_metric(["warm"], pool.warm)
        workers.add_metric(["busy"], pool.busy)
        yield workers
        yield GaugeMetricFamily("tubeloom_waiting", "Works that wait for a worker.", pool.waiting)
        yield CounterMetricFamily(
            "tubeloom_workers_lost", "Workers that died at work, or at the deadline.", pool.lost
        )


class _Present(Collector):
    def __init__(self, answering: Answering, viewers: int, jobs: Mapping[str, int]) -> None:
        self._answering, self._viewers, self._jobs = answering, viewers, jobs

    def collect(self) -> Iterable[Metric]:
        answers = CounterMetricFamily(
            "tubeloom_cache", "Answers by where they came from.", labels=["outcome"]
        )
        answers.add_metric(["hit"], self._answering.hits)
        answers.add_metric(["shared"], self._answering.shared)
        answers.add_metric(["miss"], self._answering.misses)
        yield answers
        yield GaugeMetricFamily(
            "tubeloom_event_viewers",
            "Clients that follow events of programs and jobs.",
            self._viewers,
        )
        states = GaugeMetricFamily("tubeloom_jobs", "Jobs, of all services.", labels=["state"])
        for state, number in self._jobs.items():
            states.add_metric([state], number)
        yield states


@router.get("/metrics")
async def metrics(request: Request) -> Response:
    """Figures of the service."""
    state = request.app.state
    found: Metrics = state.metrics
    viewers = state.feed.watchers + state.desk.listeners.count
    text = found.text(state.answering, viewers, await _jobs(state.database))
    return Response(text, media_type=MEDIA_TYPE, headers={"Cache-Control": "no-store"})


async def _jobs(database: Database) -> Mapping[str, int]:
    """How many jobs there are by state; nothing where the database does not tell soon."""
    try:
        async with asyncio.timeout(PATIENCE_SECONDS):
            return await database.read(jobs.counts)
    except (StoreUnavailable, TimeoutError):
        return {}
