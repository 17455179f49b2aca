"""Server-sent events as a client reads them."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import httpx

from tests.service import PATIENCE_SECONDS


@dataclass(frozen=True)
class Event:
    """One event, its data read as JSON."""

    name: str
    data: dict[str, Any]


def events(response: httpx.Response) -> Iterator[Event]:
    """All events of a response, comments left out.

    Comments show that the service lives; an event must come in time all the same.
    """
    name, end = "", time.monotonic() + PATIENCE_SECONDS
    for line in response.iter_lines():
        assert time.monotonic() < end, f"no event within {PATIENCE_SECONDS:g} s"
        if line.startswith("event: "):
            name = line.removeprefix("event: ")
        elif line.startswith("data: "):
            yield Event(name, json.loads(line.removeprefix("data: ")))
            end = time.monotonic() + PATIENCE_SECONDS
