"""Who may do what, and how often. Nothing behind it is reached without a line in the scopes."""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping
from contextvars import ContextVar

from limits import RateLimitItemPerMinute
from starlette._utils import get_route_path
from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.api.keyring import Keyring
from app.api.problems import (
    NoKeyError,
    RefusalError,
    TooManyRequestsError,
    WrongScopeError,
    problem_response,
)
from app.api.rates import Limit, Rates, rates_of_addresses, rates_of_keys
from app.api.scopes import Scope as KeyScope
from app.api.scopes import ScopeTable
from app.errors import TubeloomError
from app.settings import Settings
from app.store.keys import Key

FAILURES = RateLimitItemPerMinute(60)
"""Keys that are not valid, from one address: each costs a look into the database."""

_asker: ContextVar[tuple[Rates, str] | None] = ContextVar("asker", default=None)
"""Whose budget pays for the work of a request."""


class Guard:
    """Middleware that asks for keys, and keeps rates and budgets."""

    def __init__(self, app: ASGIApp, settings: Settings, table: ScopeTable | None = None) -> None:
        self.app = app
        self._table = table or ScopeTable()
        self._needs_keys = settings.needs_keys
        self._of_keys, self._of_addresses = rates_of_keys(settings), rates_of_addresses(settings)
        self._failures = Limit(FAILURES, "failures")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve a request, or refuse it."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        if scope["type"] != "http":  # there are no such routes, and none is to be had by mistake
            await send({"type": "websocket.close", "code": 1008, "reason": "HTTP only."})
            return
        try:
            headers = await self._admit(scope)
        except (HTTPException, RefusalError, TubeloomError) as error:
            await problem_response(Request(scope), error)(scope, receive, send)
            return
        if not headers:
            await self.app(scope, receive, send)
            return
        said = [(name.lower().encode(), value.encode()) for name, value in headers.items()]

        async def say(message: Message) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message["headers"], *said]
            await send(message)

        await self.app(scope, receive, say)

    async def _admit(self, scope: Scope) -> Mapping[str, str]:
        """Headers that tell what is left. Raises whatever is in the way."""
        needed = self._needed(scope)
        if needed is None:
            return {}
        address = address_of(scope)
        if self._needs_keys:
            key = await self._key(scope, address)
            if not allows(key, needed):
                raise WrongScopeError(needed)
            scope.setdefault("state", {})["key"] = key
            rates, asker = self._of_keys, key.id
        else:
            rates, asker = self._of_addresses, address
        if not rates:
            return {}
        _asker.set((rates, asker))
        return rates.admit(asker)

    def _needed(self, scope: Scope) -> KeyScope | None:
        methods = self._table.methods(get_route_path(scope))
        if methods is None:
            raise HTTPException(404)
        method = scope.get("method", "GET")
        if method == "HEAD" and "HEAD" not in methods:
            method = "GET"
        if method not in methods:
            raise HTTPException(405, headers={"Allow": ", ".join(methods)})
        return methods[method]

    async def _key(self, scope: Scope, address: str) -> Key:
        given = Headers(scope=scope).getlist("authorization")
        if not given:
            raise NoKeyError("Send a key: Authorization: Bearer tl_…", given=False)
        if len(given) > 1:
            raise NoKeyError("Send one key, not several.", given=True)
        kind, _, secret = given[0].partition(" ")
        secret = secret.strip()
        if kind.lower() != "bearer" or not secret:
            raise NoKeyError("Send the key as Authorization: Bearer tl_…", given=True)
        keyring: Keyring = scope["app"].state.keyring
        key = keyring.remembered(secret)
        if key is None:
            if (seconds := self._failures.wait(address, 1)) > 0:
                raise TooManyRequestsError(
                    "Too many keys from this address were not valid.",
                    {"Retry-After": str(int(seconds) + 1)},
                )
            key = await keyring.find(secret)
        if key is None:
            self._failures.add(address, 1)
            raise NoKeyError("There is no such key, or it was revoked.", given=True)
        return key


def allows(key: Key, needed: KeyScope) -> bool:
    """Whether ``key`` is good for what is ``needed``."""
    return needed in key.scopes or KeyScope.ADMIN in key.scopes


def require(request: Request, needed: KeyScope) -> None:
    """Ask for a scope beside the route's own. Raises `WrongScopeError`."""
    key: Key | None = request.scope.get("state", {}).get("key")
    if key is not None and not allows(key, needed):
        raise WrongScopeError(needed)


def has(request: Request, needed: KeyScope) -> bool:
    """Whether the request comes with a key that is good for this, or needs none."""
    key: Key | None = request.scope.get("state", {}).get("key")
    return key is None or allows(key, needed)


def key_of(request: Request) -> str | None:
    """Number of the key that the request came with, where keys are needed."""
    key: Key | None = request.scope.get("state", {}).get("key")
    return None if key is None else key.id


def afford(seconds: float) -> None:
    """Take ``seconds`` of work from the asker's budget now. Raises `TooManyRequestsError`.

    For work that will be done when the request has been answered; other work is counted as it is
    done, by `spend`.
    """
    if (found := _asker.get()) is not None:
        rates, asker = found
        rates.afford(asker, seconds * 1000)
        rates.spend(asker, seconds)


def spend(seconds: float) -> None:
    """Count ``seconds`` of work that were done for whoever asks in this context."""
    if (found := _asker.get()) is not None:
        rates, asker = found
        rates.spend(asker, seconds)


def address_of(scope: Scope) -> str:
    """Where a request comes from; of IPv6 the network, of which each client has one.

    >>> address_of({"client": ("2001:db8::17", 1)}), address_of({"client": ("10.0.0.7", 1)})
    ('2001:db8::/64', '10.0.0.7')
    """
    host = (scope.get("client") or ("unknown",))[0]
    if ":" not in host:
        return str(host)
    try:
        return str(ipaddress.ip_network((host.partition("%")[0], 64), strict=False))
    except ValueError:
        return str(host)
