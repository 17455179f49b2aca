"""What a key must be good for, route by route. A route that does not stand here is refused.

Whoever adds a route adds a line to `TABLE`; a test holds the two together.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from enum import StrEnum


class Scope(StrEnum):
    """What a key may be good for."""

    RENDER = "render"
    READ = "read"
    WRITE = "write"
    JOBS = "jobs"
    METRICS = "metrics"
    ADMIN = "admin"

    @property
    def description(self) -> str:
        """What a key with this scope may do."""
        return _DESCRIPTIONS[self]


_DESCRIPTIONS: Mapping[Scope, str] = {
    Scope.RENDER: "render, lay out and convert posted documents",
    Scope.READ: "see stored programs, and render them",
    Scope.WRITE: "change stored programs",
    Scope.JOBS: "start jobs, follow them and fetch their results",
    Scope.METRICS: "see figures of the service",
    Scope.ADMIN: "everything",
}

PUBLIC = None
"""In place of a scope: no key is needed. For what tells of the software and not of its users."""

TABLE: Mapping[str, Scope | None] = {
    "GET /healthz": PUBLIC,
    "GET /readyz": PUBLIC,
    "GET /docs": PUBLIC,
    "GET /docs/assets/{path:path}": PUBLIC,
    "GET /openapi.json": PUBLIC,
    "GET /": PUBLIC,
    "GET /viewer": PUBLIC,
    "GET /editor": PUBLIC,
    "GET /litegraph": PUBLIC,
    "GET /tube-viewer.js": PUBLIC,
    "GET /web/{path:path}": PUBLIC,
    "GET /metrics": Scope.METRICS,
    "GET /v1/notations": PUBLIC,
    "GET /v1/materials": PUBLIC,
    "GET /v1/palettes": PUBLIC,
    "GET /v1/formats": PUBLIC,
    "POST /v1/render": Scope.RENDER,
    "POST /v1/layout": Scope.RENDER,
    "POST /v1/convert": Scope.RENDER,
    "GET /v1/programs": Scope.READ,
    "GET /v1/programs/{id}": Scope.READ,
    "PUT /v1/programs/{id}": Scope.WRITE,
    "PATCH /v1/programs/{id}": Scope.WRITE,
    "DELETE /v1/programs/{id}": Scope.WRITE,
    "POST /v1/programs/{id}/edits": Scope.WRITE,
    "POST /v1/programs/{id}/undo": Scope.WRITE,
    "POST /v1/programs/{id}/redo": Scope.WRITE,
    "GET /v1/programs/{id}/revisions": Scope.READ,
    "GET /v1/programs/{id}/events": Scope.READ,
    "GET /v1/programs/{id}/render": Scope.READ,
    "GET /v1/programs/{id}/layout": Scope.READ,
    "GET /v1/programs/{id}/convert": Scope.READ,
    "POST /v1/jobs": Scope.JOBS,
    "GET /v1/jobs": Scope.JOBS,
    "GET /v1/jobs/{id}": Scope.JOBS,
    "DELETE /v1/jobs/{id}": Scope.JOBS,
    "GET /v1/jobs/{id}/events": Scope.JOBS,
    "GET /v1/jobs/{id}/result": Scope.JOBS,
}
"""Method and path of a route, as OpenAPI writes paths; ``{…:path}`` also matches slashes."""


class ScopeTable:
    """`TABLE`, or other such ``lines``, made quick to search."""

    def __init__(self, lines: Mapping[str, Scope | None] = TABLE) -> None:
        self._plain: dict[str, dict[str, Scope | None]] = {}
        patterns: dict[str, dict[str, Scope | None]] = {}
        for line, scope in lines.items():
            method, _, path = line.partition(" ")
            (patterns if "{" in path else self._plain).setdefault(path, {})[method] = scope
        self._patterns = [
            (re.compile(_regex(path)), path, found) for path, found in patterns.items()
        ]

    def methods(self, path: str) -> Mapping[str, Scope | None] | None:
        """What each method on ``path`` needs; ``None`` where nothing is."""
        return self._find(path)[1]

    def template(self, path: str) -> str | None:
        """How the line for ``path`` writes it; ``None`` where there is none."""
        return self._find(path)[0]

    def _find(self, path: str) -> tuple[str | None, dict[str, Scope | None] | None]:
        if path in self._plain:
            return path, self._plain[path]
        for pattern, template, found in self._patterns:
            if pattern.fullmatch(path):
                return template, found
        return None, None


def _regex(path: str) -> str:
    """What paths of a route look like.

    >>> _regex("/v1/jobs/{id}/events")
    '/v1/jobs/[^/]+/events'
    """
    parts = re.split(r"(\{[^}]*\})", path)
    return "".join(
        re.escape(part) if not part.startswith("{") else ".*" if ":path" in part else "[^/]+"
        for part in parts
    )
