import httpx
import pytest

from tests.service import SMALL, Service, until


def test_a_request_gets_an_id_of_its_own(client: httpx.Client) -> None:
    first, second = (client.get("/healthz").headers["x-request-id"] for _ in range(2))
    assert first
    assert first != second


def test_a_sane_id_is_kept_and_named_in_problems(client: httpx.Client) -> None:
    response = client.get("/nothing", headers={"x-request-id": "trace-1.2:3"})
    assert response.headers["x-request-id"] == "trace-1.2:3"
    assert response.json()["instance"].endswith(":trace-1.2:3")


@pytest.mark.parametrize("odd", ["", "a b", "x" * 200, "é".encode("latin-1").decode("latin-1")])
def test_an_odd_id_is_replaced(client: httpx.Client, odd: str) -> None:
    headers = {"x-request-id": odd.encode("latin-1")}
    response = client.get("/healthz", headers=headers)  # type: ignore[arg-type]  # bytes as sent
    assert response.headers["x-request-id"] not in {odd, ""}


def test_each_request_is_one_event_in_the_log(service: Service, client: httpx.Client) -> None:
    response = client.post("/v1/render", json=SMALL)
    request_id = response.headers["x-request-id"]
    events = until(
        lambda: [event for event in service.events() if event.get("request_id") == request_id]
    )
    assert len(events) == 1
    event = events[0]
    assert (event["event"], event["method"], event["path"]) == ("request", "POST", "/v1/render")
    assert (event["status"], event["bytes"]) == (200, len(response.content))
    assert event["ms"] > 0
