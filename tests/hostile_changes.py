"""Changes of a stored program that cannot be made."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

from tests.hostile_parts import base, dumped

VICTIM = dumped(base(random.Random(0)))
"""The stored program that they are for; whatever comes, it stays as it is."""

VICTIM_PATH = "/v1/programs/victim"

INDICES = ("01", "-1", "1e0", "99", "\u0660")
"""Of an item that there is not."""

PATCH = "application/json-patch+json"
MERGE = "application/merge-patch+json"
PLAIN = "application/json"


def _patch(choices: random.Random) -> bytes:
    nested: Any = 1
    for _ in range(150):
        nested = [nested]
    into_itself = [
        {"op": "add", "path": "/items/0/data", "value": {}},
        *({"op": "copy", "from": "", "path": f"/items/0/data/x{number}"} for number in range(60)),
    ]
    label = {"op": "replace", "path": "/items/0/label", "value": "y"}
    operations: Any = choices.choice(
        (
            {"op": "remove", "path": "/items/0"},
            [{"op": "explode", "path": "/items"}],
            [{"op": "remove"}],
            [{"op": "remove", "path": "items"}],
            [{"op": "remove", "path": "/items/~2"}],
            [{"op": "remove", "path": "/items/-"}],
            [{"op": "remove", "path": "/" + "x" * 20_000}],
            [{"op": "remove", "path": "/a" * 5_000}],
            [
                {
                    "op": "remove",
                    "path": "/items/" + choices.choice(INDICES),
                }
            ],
            [{"op": "remove", "path": ""}],
            [{"op": "test", "path": "/name", "value": "Another"}],
            [label, {"op": "test", "path": "/items/0/label", "value": "z"}],
            [{"op": "add", "path": "/items/0/nothing", "value": 1}],
            [{"op": "add", "path": "/name/a", "value": 1}],
            [{"op": "add", "path": "/items/7777", "value": {"id": "n"}}],
            [{"op": "replace", "path": "/items", "value": 3}],
            [{"op": "replace", "path": "/items/0/id", "value": "i1"}],
            [{"op": "replace", "path": "", "value": choices.choice(([], 1, {}, "text"))}],
            [{"op": "move", "from": "/items", "path": "/items/0/data"}],
            [{"op": "copy", "from": "/nowhere", "path": "/name"}],
            [{"op": "copy", "from": "/items/0", "path": "/items/-"}] * 50,
            into_itself,
            [*into_itself[:30], {"op": "remove", "path": "/items/0/data"}, {"op": "remove"}],
            [label] * 10_001,
            [label] * 9_999 + [{"op": "remove", "path": "/nowhere"}],
            [{"op": "add", "path": "/items/0/label", "value": nested}],
            [None] * choices.choice((1, 100_000)),
        )
    )
    return dumped(operations)


def _merge(choices: random.Random) -> bytes:
    deep = b'{"style":' * 190 + b"1" + b"}" * 190
    return choices.choice(
        (
            b'{"items": null}',
            b'{"items": 3}',
            b'{"items": {"0": null}}',
            b'{"nothing": {"at": "all"}}',
            b'{"__proto__": {"a": 1}}',
            b'{"name": {"a": "b"}}',
            b'{"style": {"palette": {"a": null}}}',
            b'{"style": {"palette": "mud"}}',
            b'{"hyperedges": [{"id": "e", "attachments": []}]}',
            b'{"items": [{"id": "a"}, {"id": "a"}]}',
            b'{"layout": NaN}',
            b'{"layout": {"clearance": 1e400}}',
            b'"text"',
            b"[]",
            b"",
            deep,
            b"[" * 100_000,
            dumped({f"k{number}": None if number else 1 for number in range(50_000)}),
        )
    )


def _edits(choices: random.Random) -> bytes:
    return choices.choice(
        (
            b"null",
            b"{}",
            b'"undo"',
            b"[" + b"[" * 500,
            b"[{}]",
            b'[{"nothing": 1}]',
            b'[{"op": "explode", "item": "i0"}]',
            b'[{"edit": "rename", "item": "i0", "to": "i1"}]',
            b"[" + b"0," * choices.choice((10, 100_000)) + b"0]",
            json.dumps([{"x" * 5000: "y" * 5000}] * 100).encode(),
        )
    )


changes: dict[str, tuple[str, str, str, Callable[[random.Random], bytes]]] = {
    "patch": ("PATCH", VICTIM_PATH, PATCH, _patch),
    "merge patch": ("PATCH", VICTIM_PATH, MERGE, _merge),
    "edits": ("POST", f"{VICTIM_PATH}/edits", PLAIN, _edits),
}
"""By kind: method, path, media type, and what makes the body."""
