"""Documents without fault, which hostile ones are made from."""

from __future__ import annotations

import json
import random
from typing import Any


def base(choices: random.Random, least: int = 3) -> dict[str, Any]:
    """A small program of several parts of the language, without fault."""
    names = [f"i{number}" for number in range(choices.randint(least, least + 5))]
    items: list[dict[str, Any]] = [
        {
            "id": name,
            "label": name.upper(),
            "shape": {"type": "box", "size": [1, 1, 0.5]},
            "position": [3 * number, 0, 0],
            "rotation": [0, 0, 30],
            "material": "plastic",
            "color": "#3b82f6",
            "attachment_points": [{"id": "top", "position": [0, 0, 1], "direction": [0, 0, 1]}],
        }
        for number, name in enumerate(names)
    ]
    return {
        "name": "A program",
        "notation": "plain",
        "items": items,
        "hyperedges": [
            {
                "id": f"e{number}",
                "attachments": [{"item": name, "point": "top"} for name in names[:3]],
                "radius": 0.08,
                "color": "#e11d48",
            }
            for number in range(choices.randint(1, 3))
        ],
        "layout": {"curves": "prose", "clearance": 0.05},
        "style": {"palette": "glasbey", "background": "#ffffff"},
    }


def dumped(document: Any) -> bytes:
    """``document`` as JSON, with whatever it holds."""
    return json.dumps(document, ensure_ascii=False).encode("utf-8", "surrogatepass")


def any_item(document: dict[str, Any], choices: random.Random) -> dict[str, Any]:
    """One of its items."""
    item: dict[str, Any] = choices.choice(document["items"])
    return item


def any_hyperedge(document: dict[str, Any], choices: random.Random) -> dict[str, Any]:
    """One of its hyperedges."""
    hyperedge: dict[str, Any] = choices.choice(document["hyperedges"])
    return hyperedge
