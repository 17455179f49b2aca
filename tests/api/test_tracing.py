import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from opentelemetry.proto.collector.trace.v1.trace_service_pb2 import ExportTraceServiceRequest
from opentelemetry.proto.trace.v1.trace_pb2 import Span

from tests.service import SMALL, running_service


class Collector:
    """A collector of traces: OTLP over HTTP, kept in memory."""

    def __init__(self) -> None:
        self.requests: list[ExportTraceServiceRequest] = []
        collector = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["Content-Length"]))
                assert self.headers["Content-Type"] == "application/x-protobuf"
                collector.requests.append(ExportTraceServiceRequest.FromString(body))
                self.send_response(200)
                self.send_header("Content-Length", "0")
                self.end_headers()

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}/v1/traces"

    @property
    def spans(self) -> list[Span]:
        return [
            span
            for request in self.requests
            for resource in request.resource_spans
            for scope in resource.scope_spans
            for span in scope.spans
        ]


@contextmanager
def collecting() -> Iterator[Collector]:
    collector = Collector()
    thread = threading.Thread(target=collector.server.serve_forever)
    thread.start()
    try:
        yield collector
    finally:
        collector.server.shutdown()
        thread.join()
        collector.server.server_close()


TRACE = "4bf92f3577b34da6a3ce929d0e0e4736"
PARENT = "00f067aa0ba902b7"


def test_requests_and_stages_become_spans_of_the_clients_trace(tmp_path: Path) -> None:
    with collecting() as collector:
        with (
            running_service(tmp_path, traces=collector.url) as service,
            service.client() as client,
        ):
            response = client.post(
                "/v1/render", json=SMALL, headers={"traceparent": f"00-{TRACE}-{PARENT}-01"}
            )
            assert response.status_code == 200
            client.get("/v1/palettes")
            client.get("/healthz")
            client.get("/v1/materials?" + "a&" * 30_000)
        # The service has ended, and has sent what there was.
        spans = {span.name: span for span in collector.spans}
        request, work = spans["POST /v1/render"], spans["work"]
        mine = [span for span in collector.spans if span.trace_id.hex() == TRACE]
        assert request.parent_span_id.hex() == PARENT
        assert work.parent_span_id == request.span_id
        stages = [span for span in mine if span.parent_span_id == work.span_id]
        assert "reading" in {span.name for span in stages}
        assert len(stages) > 3
        assert len(mine) == len(stages) + 2
        for stage in stages:
            assert work.start_time_unix_nano <= stage.start_time_unix_nano
            assert stage.end_time_unix_nano <= work.end_time_unix_nano
        assert request.start_time_unix_nano <= work.start_time_unix_nano
        assert "GET /v1/palettes" in spans
        for untraced in ("healthz", "materials"):
            assert not [span for span in collector.spans if untraced in span.name]
        (resource,) = {
            attribute.value.string_value
            for sent in collector.requests
            for found in sent.resource_spans
            for attribute in found.resource.attributes
            if attribute.key == "service.name"
        }
        assert resource == "tubeloom"


def test_a_collector_that_is_not_there_harms_nobody(tmp_path: Path) -> None:
    nobody = "http://127.0.0.1:9/v1/traces"
    with (
        running_service(tmp_path, warm=False, traces=nobody) as service,
        service.client() as client,
    ):
        assert client.get("/v1/palettes").status_code == 200
    # It has ended, and has tried to send that; to render would not make it try any other way.
    assert "Application shutdown complete." in {event["event"] for event in service.events()}
