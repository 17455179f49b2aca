"""Jobs as a client starts and follows them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import httpx

from tests.service import PATIENCE_SECONDS, fresh, until

OVER = {"done", "failed", "cancelled"}

PICTURE = "format=png&quality=final&width=64&height=48&samples=1"
"""A render that takes a second."""

LONG = "format=png&quality=final&width=320&height=240&samples=65536"
"""A render that takes minutes."""

PERIODS = (6, 12, 24, 48)
"""Seconds that a job goes on for, so that it is disturbed before it is done: where a machine was
stopped for longer, the next of these is tried."""


def lasting(seconds: int) -> Mapping[str, Any]:
    """What makes a final picture go on for so many ``seconds``, however quick the machine is."""
    return {"samples": 65536, "time_limit": seconds}


def watched(seconds: int) -> str:
    """A small picture that is drawn for so many ``seconds``; no two of it are the same."""
    return f"format=png&quality=final&width=96&height=72&samples=65536&time_limit={seconds}"


DRAWING = 0.6
"""Share of a picture's work that is done when it begins to be drawn."""


def program(name: str) -> dict[str, Any]:
    """A small program that nobody has asked for; each call gives another."""
    return {
        "name": fresh(name),
        "items": [{"id": "x"}, {"id": "y", "shape": {"type": "sphere"}}, {"id": "z"}],
        "hyperedges": [{"id": "e", "attachments": [{"item": "x"}, {"item": "y"}, {"item": "z"}]}],
    }


def start(
    client: httpx.Client, query: str, document: dict[str, Any] | bytes, **headers: str
) -> str:
    """Start a job; where it is."""
    content = document if isinstance(document, bytes) else json.dumps(document).encode()
    response = client.post(f"/v1/jobs?{query}", content=content, headers=headers)
    assert response.status_code == 202, response.text
    return response.headers["location"]


def state(client: httpx.Client, job: str) -> dict[str, Any]:
    """How a job is."""
    response = client.get(job)
    assert response.status_code == 200, response.text
    found: dict[str, Any] = response.json()
    return found


def over(client: httpx.Client, job: str, seconds: float = PATIENCE_SECONDS) -> dict[str, Any]:
    """How a job is once it is over."""

    def look() -> dict[str, Any] | None:
        found = state(client, job)
        return found if found["state"] in OVER else None

    return until(look, seconds)


def caught(client: httpx.Client, job: str, share: float = DRAWING) -> bool:
    """Whether so much of its work is done, as soon as it is, and the job is not over yet."""

    def look() -> dict[str, Any] | None:
        found = state(client, job)
        return found if found["state"] in OVER or found["share"] >= share else None

    return until(look)["state"] not in OVER


def at_work(client: httpx.Client, job: str, share: float = DRAWING) -> dict[str, Any]:
    """How a job is once so much of its work is done."""

    def look() -> dict[str, Any] | None:
        found = state(client, job)
        assert found["state"] not in OVER, found
        return found if found["share"] >= share else None

    return until(look)
