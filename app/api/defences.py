"""What browsers must know of every answer, and which hosts and pages are answered at all.

Without keys, whoever reaches the service may use it; therefore it must not be reached by way of a
browser on this machine that shows a stranger's page: neither by a name that the stranger lets
point here (DNS rebinding), nor by a form or a script that posts across origins.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Callable
from urllib.parse import urlsplit

from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.problems import (
    ForeignPageError,
    LongQueryError,
    RefusalError,
    WrongHostError,
    problem_response,
)
from app.settings import Settings

POLICY_OF_PAGES = (
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; "
    "img-src 'self' data: blob:; connect-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'self'"
)
"""Pages load their own files only; decoders of meshes are WebAssembly, and textures come out of
scenes as blobs."""

POLICY_OF_DATA = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; sandbox; frame-ancestors 'self'"
)
"""A drawing that is opened by itself has styles and textures, and runs nothing."""

UNASKED = frozenset({"/healthz", "/readyz"})
"""Paths that answer for every host: those who look after services know addresses only."""

MOST_PARAMETERS = 200
"""In one query; the call that knows the most knows some thirty."""

MOST_REPEATED = 200
"""Characters of a host or an origin that a message repeats."""

SAFE = frozenset({"GET", "HEAD", "OPTIONS"})


class Defences:
    """Middleware that refuses strange hosts and pages, and adds headers to every answer."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app = app
        self._is_known_host = known_hosts(settings)
        self._origins = None if settings.needs_keys else frozenset(settings.cors_origins)
        resource = "cross-origin" if settings.cors_origins else "same-origin"
        common = [
            (b"x-content-type-options", b"nosniff"),
            (b"referrer-policy", b"no-referrer"),
            (b"cross-origin-resource-policy", resource.encode()),
        ]
        self._of_data = [*common, (b"content-security-policy", POLICY_OF_DATA.encode())]
        self._of_pages = [
            *common,
            (b"cross-origin-opener-policy", b"same-origin"),
            (b"permissions-policy", b"camera=(), geolocation=(), microphone=()"),
        ]

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request, or refuse it."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return

        async def defend(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *self._headers(message["headers"])]
            await send(message)

        try:
            self._check(scope)
        except RefusalError as error:
            await problem_response(Request(scope), error)(scope, receive, defend)
            return
        await self.app(scope, receive, defend)

    def _headers(self, present: list[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
        is_page = has_policy = False
        for name, value in present:
            if name == b"content-type":
                is_page = value.startswith(b"text/html")
            elif name == b"content-security-policy":
                has_policy = True
        if not is_page:
            return self._of_data
        policy = [] if has_policy else [(b"content-security-policy", POLICY_OF_PAGES.encode())]
        return [*self._of_pages, *policy]

    def _check(self, scope: Scope) -> None:
        parameters = scope["query_string"].count(b"&") + 1
        if parameters > MOST_PARAMETERS:
            raise LongQueryError(
                f"The query has {parameters} parameters; at most {MOST_PARAMETERS} are read."
            )
        host = origin = b""
        for name, value in scope["headers"]:
            if name == b"host":
                host = value
            elif name == b"origin":
                origin = value
        if self._is_known_host is not None and scope["path"] not in UNASKED:
            name = host_name(host.decode("latin-1"))
            if not self._is_known_host(name):
                said = name[:MOST_REPEATED] or "a nameless host"
                raise WrongHostError(
                    f"This service does not answer for {said}; "
                    "TUBELOOM_HOSTS says for which it does."
                )
        if origin and self._origins is not None and scope["method"] not in SAFE:
            self._check_origin(origin.decode("latin-1"), host.decode("latin-1"), self._origins)

    def _check_origin(self, origin: str, host: str, origins: frozenset[str]) -> None:
        if origin in origins or "*" in origins or origin.partition("://")[2] == host:
            return
        raise ForeignPageError(
            f"Pages of {origin[:MOST_REPEATED]} may not change anything here; "
            "TUBELOOM_CORS_ORIGINS says whose may."
        )


def known_hosts(settings: Settings) -> Callable[[str], bool] | None:
    """Which hosts the service answers for; ``None``: for all."""
    if settings.hosts:
        names = frozenset(name.lower() for name in settings.hosts)
        return lambda name: name in names
    return None if settings.needs_keys or not settings.is_local else is_this_machine


def is_this_machine(name: str) -> bool:
    """Whether a host name means the machine on which it is said.

    >>> is_this_machine("localhost"), is_this_machine("127.0.0.1"), is_this_machine("a.example")
    (True, True, False)
    """
    if name in {"localhost", "127.0.0.1", "::1"} or name.endswith(".localhost"):
        return True
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def host_name(host: str) -> str:
    """The name in a ``Host`` header, without its port.

    >>> host_name("LOCALHOST:8000"), host_name("[::1]:8000"), host_name("[")
    ('localhost', '::1', '')
    """
    try:
        return (urlsplit(f"//{host}").hostname or "").rstrip(".")
    except ValueError:
        return ""
