"""Spans of requests, and of the stages of their work, for an OpenTelemetry collector.

FastAPI makes those of requests itself, once it has a provider, and goes on with the trace that a
client began. Those of stages are made when the work has been done, as its worker measured them.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from starlette.types import Scope

from app import __version__
from app.jobs.work import Stage
from app.settings import Settings

if TYPE_CHECKING:
    from fastapi.telemetry import TelemetryConfig
    from opentelemetry.sdk.trace import TracerProvider

OFF: TelemetryConfig = {"tracing": False, "metrics": False, "logs": False}

UNTRACED = frozenset({"/healthz", "/readyz", "/metrics"})
"""Paths that machines ask for all the time, about which nobody wants to read."""

LONGEST_QUERY = 8192
"""In bytes. FastAPI reads the query of whatever it traces, and a longer one for too long."""


class TelemetryMissingError(ImportError):
    """Traces are asked for, and the packages that send them are not installed."""


class Tracing:
    """Sends spans to the collector at ``url``. Raises `TelemetryMissingError`."""

    def __init__(self, url: str) -> None:
        self._provider = _provider(url)
        self._tracer = self._provider.get_tracer("tubeloom", __version__)

    @property
    def config(self) -> TelemetryConfig:
        """What FastAPI must know."""
        return {
            "tracer_provider": self._provider,
            "tracing": True,
            "metrics": False,
            "logs": False,
            "operation_spans": False,
            "auto_configure": False,
            "exclude": _is_untraced,
        }

    def note_work(self, seconds: float, stages: Sequence[Stage]) -> None:
        """Make spans of work that took so many ``seconds`` and ended now."""
        from opentelemetry import trace

        end = time.time_ns()
        begin = end - _nanoseconds(seconds)
        span = self._tracer.start_span("work", start_time=begin)
        context = trace.set_span_in_context(span)
        # The worker's own time; what is left of it went by on the way there and back.
        at = end - _nanoseconds(sum(stage.seconds for stage in stages))
        for stage in stages:
            part = self._tracer.start_span(stage.name, context, start_time=at)
            at += _nanoseconds(stage.seconds)
            part.end(at)
        span.end(end)

    def close(self) -> None:
        """Send what has not been sent, within seconds."""
        self._provider.shutdown()


def _is_untraced(scope: Scope) -> bool:
    return scope.get("path") in UNTRACED or len(scope.get("query_string", b"")) > LONGEST_QUERY


def tracing_of(settings: Settings) -> Tracing | None:
    """What the settings ask for. Raises `TelemetryMissingError`."""
    return None if settings.traces is None else Tracing(settings.traces)


def _provider(url: str) -> TracerProvider:
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
        from opentelemetry.sdk.resources import Resource
        from opentelemetry.sdk.trace import TracerProvider
        from opentelemetry.sdk.trace.export import BatchSpanProcessor
    except ImportError as error:
        raise TelemetryMissingError(
            "TUBELOOM_TRACES needs packages that are not here: pip install 'tubeloom[telemetry]'."
        ) from error
    resource = Resource.create({"service.name": "tubeloom", "service.version": __version__})
    provider = TracerProvider(resource=resource, shutdown_on_exit=False)
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter(endpoint=url, timeout=5)))
    return provider


def _nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)
