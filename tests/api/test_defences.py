import httpx
import pytest

from tests.api.raw import host_of
from tests.service import SMALL, Service

COMMON = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
}


@pytest.mark.parametrize(
    ("method", "path", "status", "more"),
    [
        ("POST", "/v1/render", 200, {"json": SMALL}),
        ("POST", "/v1/render?format=png&width=64&height=64", 200, {"json": SMALL}),
        ("POST", "/v1/render?format=svg", 200, {"json": SMALL}),
        ("POST", "/v1/render", 200, {"json": SMALL, "headers": {"Accept": "text/event-stream"}}),
        ("POST", "/v1/layout", 200, {"json": SMALL}),
        ("GET", "/docs", 200, {}),
        ("GET", "/docs/assets/swagger-ui.css", 200, {}),
        ("GET", "/openapi.json", 200, {}),
        ("GET", "/metrics", 200, {}),
        ("GET", "/v1/palettes", 200, {}),
        ("GET", "/v1/palettes", 304, {"headers": {"If-None-Match": "*"}}),
        ("POST", "/v1/render", 400, {"content": b"no"}),
        ("POST", "/v1/render?format=png&errors=image", 400, {"content": b"no"}),
        ("GET", "/nowhere", 404, {}),
        ("GET", "/docs/assets/nothing", 404, {}),
        ("GET", "/v1/render", 405, {}),
        ("POST", "/v1/render", 406, {"json": SMALL, "headers": {"Accept": "text/plain"}}),
        ("POST", "/v1/render", 413, {"content": b" " * 40_000_000}),
        ("POST", "/v1/render", 415, {"content": b"", "headers": {"Content-Type": "text/css"}}),
        ("POST", "/v1/render", 403, {"json": SMALL, "headers": {"Origin": "https://a.example"}}),
        ("GET", "/v1/palettes", 421, {"headers": {"Host": "a.example"}}),
    ],
)
def test_every_answer_tells_browsers_to_be_careful(
    method: str, path: str, status: int, more: dict[str, object], client: httpx.Client
) -> None:
    with client.stream(method, path, **more) as answer:  # type: ignore[arg-type]
        assert answer.status_code == status
        for name, value in COMMON.items():
            assert answer.headers.get_list(name) == [value]
        (policy,) = answer.headers.get_list("content-security-policy")
        assert "default-src" in policy
        if answer.headers.get("content-type", "").startswith("text/html"):
            assert answer.headers["cross-origin-opener-policy"] == "same-origin"
        else:
            assert "sandbox" in policy
        assert "server" not in answer.headers


@pytest.mark.parametrize(
    "host",
    [
        "a.example",
        "127.0.0.1.a.example",
        "localhost.a.example:80",
        "192.168.1.7",
        "8.8.8.8",
        "",
        "[",
    ],
)
def test_names_that_strangers_point_here_are_not_answered(host: str, client: httpx.Client) -> None:
    answer = client.post("/v1/layout", json=SMALL, headers={"Host": host})
    assert answer.status_code == 421
    assert answer.json()["type"] == "urn:tubeloom:problem:wrong-host"
    # Who watches over services knows addresses only.
    assert client.get("/readyz", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host", ["localhost", "LOCALHOST:81", "app.localhost", "127.0.0.1", "127.9.9.9:1", "[::1]:80"]
)
def test_names_of_this_machine_are_answered(host: str, client: httpx.Client) -> None:
    assert client.get("/v1/palettes", headers={"Host": host}).status_code == 200


def test_pages_of_strangers_may_not_ask(service: Service, client: httpx.Client) -> None:
    for origin in ("https://a.example", "null", "http://localhost:1", "http://127.0.0.1"):
        answer = client.post("/v1/layout", json=SMALL, headers={"Origin": origin})
        assert answer.status_code == 403, origin
        assert answer.json()["type"] == "urn:tubeloom:problem:foreign-page"
        seen = client.get("/v1/palettes", headers={"Origin": origin})
        assert seen.status_code == 200
        assert "access-control-allow-origin" not in seen.headers
    own = f"http://{host_of(service)}"
    assert client.post("/v1/layout", json=SMALL, headers={"Origin": own}).status_code == 200


def test_a_form_of_a_stranger_is_refused(client: httpx.Client) -> None:
    # A form needs no preflight, and what it sends can look like JSON.
    headers = {"Origin": "https://a.example", "Content-Type": "application/x-www-form-urlencoded"}
    answer = client.post("/v1/layout", content=b'{"items": []}', headers=headers)
    assert answer.status_code == 403


def test_hosts_and_origins_are_those_of_the_settings(strict: Service) -> None:
    with strict.client() as client:
        for host, status in (
            ("tubes.example", 200),
            ("Tubes.Example:8000", 200),
            ("localhost", 421),
        ):
            assert client.get("/v1/palettes", headers={"Host": host}).status_code == status
        for origin, status in (("https://pages.example", 200), ("https://other.example", 403)):
            answer = client.post("/v1/layout", json=SMALL, headers={"Origin": origin})
            assert answer.status_code == status
            assert answer.headers.get("access-control-allow-origin") == (
                origin if status == 200 else None
            )
