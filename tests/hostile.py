"""Requests that mean harm, or are broken: as many as wanted, the same for the same seed.

Each of them is wrong for certain, so a service that takes one is at fault.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import quote, urlencode

from tests.hostile_bodies import bodies
from tests.hostile_changes import VICTIM_PATH, changes
from tests.hostile_parts import base, dumped
from tests.hostile_trees import trees


@dataclass(frozen=True)
class Hostile:
    """A request, and what is the matter with it."""

    kind: str
    path: str
    body: bytes
    headers: Mapping[str, str] = field(default_factory=dict)
    method: str = "POST"

    def __str__(self) -> str:
        shown = self.body[:80] + (b"..." if len(self.body) > 80 else b"")
        return f"{self.kind}: {self.method} {self.path[:200]} {shown!r} ({len(self.body)} bytes)"


PATHS = (
    "/v1/render",
    "/v1/render?format=png&width=64&height=64",
    "/v1/render?format=svg",
    "/v1/render?format=stl",
    "/v1/layout",
    "/v1/layout?patches=true",
    "/v1/convert",
    "/v1/convert?to=hif",
)


STORED_SHARE = 0.2
"""Of documents, those that are to be stored."""


def hostile(number: int, seed: int = 1) -> Hostile:
    """The request of that ``number``; the kinds take turns."""
    choices = random.Random(f"{seed}/{number}")
    kind = list(KINDS)[number % len(KINDS)]
    return KINDS[kind](kind, choices)


def all_hostile(amount: int, seed: int = 1) -> Iterator[Hostile]:
    """So many requests, one after another."""
    return (hostile(number, seed) for number in range(amount))


def _documents(make: Callable[[random.Random], bytes]) -> Callable[[str, random.Random], Hostile]:
    def request(kind: str, choices: random.Random) -> Hostile:
        # Conversions hand names on that they have no use for.
        paths = [path for path in PATHS if kind != "unknown" or "convert" not in path]
        path, body = choices.choice(paths), make(choices)
        if choices.random() < STORED_SHARE:
            return Hostile(kind, VICTIM_PATH, body, method="PUT")
        return Hostile(kind, path, body)

    return request


def _change(kind: str, choices: random.Random) -> Hostile:
    method, path, media_type, make = changes[kind]
    return Hostile(kind, path, make(choices), {"Content-Type": media_type}, method)


def _encoded(kind: str, choices: random.Random) -> Hostile:
    """What would be large if somebody unpacked it."""
    import bz2
    import gzip
    import lzma
    import zlib

    size = choices.choice((10_000, 1_000_000, 20_000_000))
    plain = b'{"items": [' + b" " * size + b"]}"
    coding, body = choices.choice(
        (
            ("gzip", gzip.compress(plain, 6)),
            ("deflate", zlib.compress(plain)),
            ("x-gzip", gzip.compress(gzip.compress(plain))),
            ("gzip, gzip", gzip.compress(gzip.compress(plain))),
            ("br", b"\x8b\x00\x80" + bytes(100)),
            ("zstd", b"\x28\xb5\x2f\xfd" + bytes(100)),
            ("bzip2", bz2.compress(plain[:1_000_000])),
            ("xz", lzma.compress(plain[:1_000_000], preset=0)),
            ("identity;q=0", plain[:100]),
            ("\xe9", plain[:100]),
        )
    )
    return Hostile(kind, choices.choice(PATHS), body, {"Content-Encoding": coding})


def _media_type(kind: str, choices: random.Random) -> Hostile:
    media_type = choices.choice(
        (
            "text/xml",
            "multipart/form-data; boundary=x",
            "application/x-yaml",
            "application/zip",
            "image/png",
            "text/html; charset=utf-7",
            "application/octet-stream",
            "json",
            "/",
            ";",
            "application/" + "x" * 5000,
            "application/json+",
        )
    )
    return Hostile(kind, choices.choice(PATHS), dumped(base(choices)), {"Content-Type": media_type})


def _accept(kind: str, choices: random.Random) -> Hostile:
    accept = choices.choice(
        (
            "text/plain",
            "application/x-msdownload",
            "*/*;q=0",
            "image/png;q=0",
            "nothing",
            ", ".join(f"a/b{number}" for number in range(1500)),
            "application/json" + ";a=b" * 3000 + ";q=0",
        )
    )
    return Hostile(kind, "/v1/layout", dumped(base(choices)), {"Accept": accept})


def _query(kind: str, choices: random.Random) -> Hostile:
    number = choices.choice(
        (
            "-1",
            "0",
            "1e9",
            "99999999999999999999",
            "NaN",
            "Infinity",
            "0x10",
            "1.5",
            "",
            "null",
            "١٢",
            "8193",
            "9" * 5000,
            "%00",
            "[]",
            "../..",
        )
    )
    name = choices.choice(("width", "height", "frames", "samples", "seed", "parts", "quality"))
    absurd = choices.choice(
        (
            urlencode({name: number if name != "seed" else "-1"}),
            "format=" + choices.choice(("exe", "PNG", "", "glb,png", "%00", "x" * 3000)),
            "from=" + choices.choice(("../../etc/passwd", "pickle", "yaml", "%F0%9F%92%A3")),
            "&".join(f"p{each}=1" for each in range(choices.choice((1, 100, 3000)))),
            "width=1&width=" + number,
            "sheet=true&sweep=/style/halo=0,1",
            "format=glb&sheet=true",
            "sweep=" + quote("/style/halo=" + ",".join(["0.1"] * 400)),
            "sweep=" + quote("/nothing/here=1,2"),
            "sweep=" + quote("/items/0/id=1,2") + "&sweep=a&sweep=b",
            "sweep="
            + quote(choices.choice(("=", "/", "/style/halo", "style=1", "/~2=1", "/=" * 300))),
            "scale=" + choices.choice(("0", "-1", "nan", "inf", "1e400", "ten")),
            "noise=" + choices.choice(("0", "2", "nan", "-0.1")),
            "time_limit=" + choices.choice(("0", "1e9", "nan", "inf")),
            "duration=" + choices.choice(("0", "-3", "1e9", "inf")),
            "sheet=" + choices.choice(("yes", "1", "TRUE", "")),
            "errors=" + choices.choice(("xml", "json;image", "")),
            "%ff%fe=1",
            "a" * 20_000 + "=1",
            "__class__=1&constructor=2&%24where=3",
        )
    )
    return Hostile(kind, f"/v1/render?{absurd}", dumped(base(choices)))


KINDS: dict[str, Callable[[str, random.Random], Hostile]] = {
    **{name: _documents(make) for name, make in {**bodies, **trees}.items()},
    **dict.fromkeys(changes, _change),
    "packed": _encoded,
    "media type": _media_type,
    "accept": _accept,
    "query": _query,
}


def described(problem: Any) -> str | None:
    """What is wrong about a problem as it came, if something is."""
    if not isinstance(problem, dict):
        return "is not an object"
    missing = {"type", "title", "status", "detail", "instance"} - set(problem)
    if missing:
        return f"lacks {sorted(missing)}"
    if "Traceback" in json.dumps(problem) or "/app/" in json.dumps(problem):
        return "shows our insides"
    return None
