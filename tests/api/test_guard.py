import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts
from starlette.routing import Mount

from app.api.scopes import PUBLIC, TABLE, Scope
from app.main import create_app
from app.settings import Settings
from tests.api.keys import bearer, make_key, tubeloom
from tests.api.raw import exchange, host_of, status_of
from tests.children import run
from tests.service import SMALL, Service, until

OPEN = {
    "GET /",
    "GET /docs",
    "GET /docs/assets/{}",
    "GET /editor",
    "GET /healthz",
    "GET /litegraph",
    "GET /openapi.json",
    "GET /readyz",
    "GET /tube-viewer.js",
    "GET /v1/formats",
    "GET /v1/materials",
    "GET /v1/notations",
    "GET /v1/palettes",
    "GET /viewer",
    "GET /web/{}",
}
"""What anybody may see; here once more, so that nobody opens a route by mistake."""

REFUSALS = {"no-key", "not-found", "method-not-allowed"}
"""Kinds of problem that the guard itself answers with."""


def same(line: str) -> str:
    """A line without the names of what stands in its path."""
    return re.sub(r"\{[^}]*\}", "{}", line)


def lines_of(app: FastAPI) -> set[str]:
    """Every route of ``app``, as the table writes them."""
    found = set()
    for context in iter_route_contexts(app.routes):
        route = context.original_route
        if isinstance(route, Mount):
            found.add(f"GET {route.path}/{{}}")
            continue
        assert context.path, f"{route!r} is of a kind that nobody guards"
        methods = set(context.methods or ())
        # Starlette adds HEAD to whatever answers GET; the guard takes it for GET.
        found |= {f"{method} {context.path}" for method in methods - {"HEAD"}}
    return {same(line) for line in found}


def described(app: FastAPI) -> set[str]:
    return {
        same(f"{method.upper()} {path}")
        for path, methods in app.openapi()["paths"].items()
        for method in methods
    }


ROUTES = lines_of(create_app(Settings()))
LINES = {same(line): scope for line, scope in TABLE.items()}
GUARDED = sorted(line for line in {*LINES, *ROUTES} - OPEN)


def test_the_routes_are_found() -> None:
    assert described(create_app(Settings())) <= ROUTES
    assert {"POST /v1/render", "GET /metrics", "GET /docs", "GET /docs/assets/{}"} <= ROUTES


def test_every_route_stands_in_the_table() -> None:
    assert set(LINES) >= ROUTES, "add a line to app.api.scopes.TABLE"


def test_nothing_is_open_by_mistake() -> None:
    assert {line for line, scope in LINES.items() if scope is PUBLIC} == OPEN


@pytest.fixture
def stranger(guarded: Service) -> Iterator[httpx.Client]:
    with guarded.client() as client:
        yield client


@pytest.fixture(scope="module")
def keys(guarded_folder: Path) -> dict[Scope, str]:
    return {scope: make_key(guarded_folder / "data", scope.value) for scope in Scope}


@pytest.fixture(scope="module")
def keys_for_all_but(guarded_folder: Path) -> dict[Scope, str]:
    plain = [scope for scope in Scope if scope is not Scope.ADMIN]
    return {
        scope: make_key(
            guarded_folder / "data", *(other.value for other in plain if other is not scope)
        )
        for scope in plain
    }


def ask(
    client: httpx.Client, line: str, headers: dict[str, str] | None = None
) -> tuple[int, httpx.Headers]:
    """The status and headers of an answer; not its body, which may go on for ever."""
    method, _, path = line.partition(" ")
    with client.stream(method, path.replace("{}", "nothing"), headers=headers) as response:
        return response.status_code, response.headers


@pytest.mark.parametrize("line", GUARDED)
def test_a_route_wants_a_key_that_is_good_for_it(
    line: str,
    stranger: httpx.Client,
    keys: dict[Scope, str],
    keys_for_all_but: dict[Scope, str],
) -> None:
    needed = LINES[line]
    assert needed is not None
    status, headers = ask(stranger, line)
    assert status == 401
    assert headers["www-authenticate"] == 'Bearer realm="tubeloom"'
    assert headers["content-type"] == "application/problem+json"

    status, headers = ask(stranger, line, bearer("tl_" + "0" * 43))
    assert status == 401
    assert 'error="invalid_token"' in headers["www-authenticate"]

    status, headers = ask(stranger, line, bearer(keys_for_all_but[needed]))
    assert status == 403
    assert f'scope="{needed}"' in headers["www-authenticate"]
    assert headers["content-type"] == "application/problem+json"

    for scope in (needed, Scope.ADMIN):
        status, headers = ask(stranger, line, bearer(keys[scope]))
        assert status not in {401, 403}
        assert "www-authenticate" not in headers


@pytest.mark.parametrize("line", sorted(OPEN))
def test_what_is_open_wants_no_key(line: str, stranger: httpx.Client) -> None:
    status, _ = ask(stranger, line)
    assert status not in {401, 403}
    status, _ = ask(stranger, line, bearer("tl_" + "1" * 43))
    assert status not in {401, 403}


def disguises(path: str) -> list[str]:
    first, rest = path[1], path[2:]
    encoded = f"%{ord(first):02x}"
    return [
        f"{path}/",
        f"/{path}",
        f"//{path}",
        f"/.{path}",
        f"/x/..{path}",
        f"/x/%2e%2e{path}",
        f"/docs/assets/..{path}",
        f"/docs/assets/../..{path}",
        f"/docs/assets/%2e%2e/%2e%2e{path}",
        f"/docs/assets/..%2f..{path}",
        f"/healthz/..{path}",
        f"/healthz;{path}",
        f"/healthz?{path}",
        f"/healthz%00{path}",
        f"/healthz%0a{path}",
        f"/healthz%0d%0aX:{path}",
        f"{path};",
        f"{path}%00",
        f"{path}%0a",
        f"{path}%20",
        f"{path}%2f",
        f"{path}.json",
        f"{path}#",
        f"{path}?key=tl_x&access_token=tl_x&authorization=Bearer%20tl_x",
        f"/{first.upper()}{rest}",
        path.upper(),
        f"/{encoded}{rest}",
        f"/%25{encoded[1:]}{rest}",
        f"http://localhost{path}",
        f"http://user@localhost{path}",
        path.replace("/", "\\"),
        path.replace("/", "%2f"),
        path.replace("/", "%5c"),
    ]


METHODS = ["HEAD", "OPTIONS", "TRACE", "PROPFIND", "get", "post", "BREW", "CONNECT", "QUERY"]
HEADERS = [
    "X-HTTP-Method-Override: GET",
    "X-Original-URL: /healthz",
    "X-Rewrite-URL: /healthz",
    "X-Forwarded-Prefix: /healthz",
    "X-Forwarded-For: 127.0.0.1",
    "X-Forwarded-Host: localhost",
    "Forwarded: for=127.0.0.1",
    "Authorization: Bearer",
    "Authorization: Bearer ",
    "Authorization: Basic dXNlcjp0bF94",
    "Authorization: Bearer tl_\xe9",
    "Authorization: Bearer null",
    "Authorization: Bearer %",
    "Authorization: Bearer ' OR 1=1 --",
    "Cookie: authorization=Bearer tl_x; key=tl_x",
    "X-API-Key: tl_x",
    (
        "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ=="
    ),
    "Connection: Upgrade\r\nUpgrade: h2c",
]


def request_of(service: Service, method: str, target: str, header: str = "X: x") -> bytes:
    body = b'{"items": [{"id": "a"}]}'
    return (
        f"{method} {target} HTTP/1.1\r\nHost: {host_of(service)}\r\n{header}\r\n"
        f"Connection: close\r\nContent-Length: {len(body)}\r\n\r\n"
    ).encode("latin-1") + body


REAL = ["POST /v1/render", "POST /v1/layout", "POST /v1/convert", "GET /metrics"]
"""Where an answer of 200 would show that somebody came through."""


@pytest.mark.parametrize("line", REAL)
def test_nothing_gets_around_the_guard(line: str, guarded: Service, keys: dict[Scope, str]) -> None:
    method, _, path = line.partition(" ")
    requests = [request_of(guarded, method, disguise) for disguise in disguises(path)]
    requests += [request_of(guarded, other, path) for other in METHODS]
    requests += [request_of(guarded, method, path, header) for header in HEADERS]
    right = f"Authorization: Bearer {keys[Scope.ADMIN]}"
    requests += [
        request_of(guarded, method, path, f"{right}\r\n{right}"),
        request_of(guarded, method, path, f"{right}\r\nAuthorization: Bearer tl_x"),
        request_of(guarded, method, path, f"Authorization: Bearer tl_x\r\n{right}"),
        request_of(guarded, method, path, right.lower().replace("bearer", "token")),
    ]
    for request in requests:
        answer = exchange(guarded, request)
        status = status_of(answer)
        if request.split(b" ")[1].startswith(b"/healthz?") and method == "GET":
            assert (status, b'{"status":"ok"}' in answer) == (200, True)
            continue
        assert status in {400, 401, 404, 405}, (request, answer)
        if status != 400:  # which the server's own parser says, before anything is looked at
            body = answer.partition(b"\r\n\r\n")[2]
            kind = re.search(rb"urn:tubeloom:problem:([a-z-]+)", body)
            assert request.startswith(b"HEAD") or (kind and kind[1].decode() in REFUSALS), answer
    good = exchange(guarded, request_of(guarded, method, path, right))
    assert status_of(good) == 200


def test_a_key_may_be_shown_by_a_scheme_in_any_case(
    stranger: httpx.Client, keys: dict[Scope, str]
) -> None:
    for scheme in ("Bearer", "bearer", "BEARER"):
        headers = {"Authorization": f"{scheme} {keys[Scope.RENDER]}"}
        assert stranger.post("/v1/layout", json=SMALL, headers=headers).status_code == 200


def test_keys_are_made_listed_and_revoked_on_the_command_line(
    guarded_folder: Path, stranger: httpx.Client
) -> None:
    data = guarded_folder / "data"
    # In a process of its own, as people do it.
    made = run(
        [sys.executable, "-m", "app", "keys", "create", "for a day", "--scope", "render"],
        env={**os.environ, "TUBELOOM_DATA_FOLDER": str(data)},
    )
    assert made.returncode == 0
    assert re.fullmatch(r"tl_[A-Za-z0-9_-]{43}\n", made.stdout)
    assert "only now" in made.stderr
    secret = made.stdout.strip()
    assert stranger.post("/v1/layout", json=SMALL, headers=bearer(secret)).status_code == 200

    def line() -> str:
        listed = tubeloom("keys", "list", data_folder=data)
        assert listed.exit_code == 0
        assert secret not in listed.stdout
        return next(each for each in listed.stdout.splitlines() if "for a day" in each)

    key_id = line().split()[0]
    until(lambda: re.search(" render .*used 2", line()))

    assert tubeloom("keys", "revoke", key_id, data_folder=data).exit_code == 0
    assert "revoked 2" in line()

    def refused() -> bool:
        response = stranger.post("/v1/layout", json=SMALL, headers=bearer(secret))
        return response.status_code == 401

    until(refused, 10)
    again = tubeloom("keys", "revoke", key_id, data_folder=data)
    assert again.exit_code == 1
    assert "no valid key" in again.stderr
    unknown = tubeloom("keys", "create", "bad", "--scope", "everything", data_folder=data)
    assert unknown.exit_code == 2


def test_secrets_are_not_kept(
    guarded_folder: Path, keys: dict[Scope, str], guarded: Service
) -> None:
    kept = b"".join(file.read_bytes() for file in (guarded_folder / "data").glob("tubeloom.db*"))
    assert kept
    for secret in keys.values():
        assert secret.encode() not in kept
        assert secret.removeprefix("tl_").encode() not in kept
    written = guarded.log.read_text()
    assert not any(secret in written for secret in keys.values())


def test_pages_of_allowed_origins_may_ask(stranger: httpx.Client, keys: dict[Scope, str]) -> None:
    asks = {
        "Origin": "https://b.example",
        "Access-Control-Request-Method": "POST",
        "Access-Control-Request-Headers": "authorization, content-type",
    }
    preflight = stranger.options("/v1/render", headers=asks)
    assert preflight.status_code == 200
    assert preflight.headers["access-control-allow-origin"] == "https://b.example"
    assert "POST" in preflight.headers["access-control-allow-methods"]
    assert "authorization" in preflight.headers["access-control-allow-headers"].lower()
    assert "access-control-allow-credentials" not in preflight.headers

    foreign = stranger.options("/v1/render", headers={**asks, "Origin": "https://evil.example"})
    assert foreign.status_code == 400
    assert "access-control-allow-origin" not in foreign.headers

    mine = {"Origin": "https://b.example"}
    headers = {**mine, **bearer(keys[Scope.RENDER])}
    answer = stranger.post("/v1/layout", json=SMALL, headers=headers)
    assert answer.status_code == 200
    assert answer.headers["access-control-allow-origin"] == "https://b.example"
    assert "ETag" in answer.headers["access-control-expose-headers"]
    assert answer.headers["cross-origin-resource-policy"] == "cross-origin"
    # That a key is missing must be legible, too.
    refusal = stranger.post("/v1/layout", json=SMALL, headers=mine)
    assert refusal.status_code == 401
    assert refusal.headers["access-control-allow-origin"] == "https://b.example"
