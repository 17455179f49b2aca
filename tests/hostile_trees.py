"""Documents that are too deep, too wide, or contradict themselves."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

from tests.hostile_bodies import repeated_key
from tests.hostile_parts import any_hyperedge, any_item, base, dumped


def _deep(choices: random.Random) -> bytes:
    depth = choices.choice((201, 1000, 100_000, 1_000_000))
    match choices.randrange(4):
        case 0:
            return b"[" * depth + b"]" * depth
        case 1:
            return b"[" * depth
        case 2:
            return b'{"a":' * depth + b"1" + b"}" * depth
        case _:
            good = dumped(base(choices))
            return good[:-1] + b', "data": {"a": ' + b"[" * depth + b"]" * depth + b"}}"


def _within(choices: random.Random) -> bytes:
    """Items within items within items."""
    depth = choices.choice((65, 500, 15_000))
    items = [
        {"id": f"d{number}", **({"parent": f"d{number - 1}"} if number else {})}
        for number in range(depth + 1)
    ]
    choices.shuffle(items)
    return dumped({"items": items})


def _cycle(choices: random.Random) -> bytes:
    document = base(choices)
    length = choices.choice((1, 2, 3, 60, 5000))
    names = [f"c{number}" for number in range(length)]
    document["items"] += [
        {"id": name, "parent": names[number - 1]} for number, name in enumerate(names)
    ]
    return dumped(document)


def _wide(choices: random.Random) -> bytes:
    document = base(choices)
    match choices.randrange(6):
        case 0:
            document["items"] = [{"id": str(number)} for number in range(20_001)]
        case 1:
            one = {"id": "e", "attachments": []}
            document["hyperedges"] = [one] * 100_001
        case 2:
            ends = [{"item": "i0"}] * 1000
            document["hyperedges"] = [
                {"id": str(number), "attachments": ends} for number in range(401)
            ]
        case 3:
            return b'{"items": [' + b"0," * 2_000_001 + b"0]}"
        case 4:
            document.update({f"k{number}": number for number in range(100_000)})
        case _:
            item = any_item(document, choices)
            item.update({f"k{number}": {} for number in range(choices.choice((1, 2000, 50_000)))})
    return dumped(document)


def _twice(choices: random.Random) -> bytes:
    document = base(choices)
    match choices.randrange(4):
        case 0:
            return repeated_key(document, choices)
        case 1:
            document["items"].append(any_item(document, choices))
        case 2:
            document["hyperedges"].append(any_hyperedge(document, choices))
        case _:
            points = any_item(document, choices)["attachment_points"]
            points.append(points[0])
    return dumped(document)


def _unknown(choices: random.Random) -> bytes:
    document = base(choices)
    hyperedge, item = any_hyperedge(document, choices), any_item(document, choices)
    match choices.randrange(9):
        case 0:
            hyperedge["attachments"][1]["item"] = "nobody"
        case 1:
            hyperedge["attachments"][1]["point"] = "nowhere"
        case 2:
            item["parent"] = "nobody"
        case 3:
            document["notation"] = choices.choice(("klingon", "../plain", "plain\x00", "Plain"))
        case 4:
            document["style"]["palette"] = choices.choice(("mud", "../glasbey", ""))
        case 5:
            document["layout"]["constraints"] = [{"type": "row", "items": ["nobody", "i0"]}]
        case 6:
            item["material"] = "unobtainium"
        case 7:
            hyperedge["attachments"] = choices.choice(([], [{"item": "i0"}]))
        case _:
            document[choices.choice(("item", "Items", "$schema", "__proto__", "constructor"))] = {}
    return dumped(document)


def _csg(choices: random.Random) -> bytes:
    document = base(choices)
    ball: dict[str, Any] = {"type": "sphere", "radius": 1}
    plane: dict[str, Any] = {"type": "half_space", "normal": [0, 0, 1]}
    operation = choices.choice(("union", "intersection", "difference"))
    tree: dict[str, Any]
    match choices.randrange(7):
        case 0:
            tree = ball
            for _ in range(choices.choice((64, 95))):
                tree = {"type": operation, "of": [tree, ball]}
        case 1:
            tree = {"type": operation, "of": [ball] * choices.choice((1000, 100_000))}
        case 2:  # a tree whose branches double at each level
            tree = ball
            for _ in range(11):
                tree = {"type": operation, "of": [tree, tree]}
        case 3:
            tree = {"type": "union", "of": [plane, ball]}
        case 4:
            tree = {"type": "intersection", "of": [ball, {**plane, "normal": [0, 0, 0]}]}
        case 5:
            tree = {"type": operation, "of": []}
        case _:
            strange: Any = choices.choice(
                ({}, 3, None, [], {"type": "minkowski", "of": [ball, ball]})
            )
            tree = {"type": operation, "of": [ball, strange]}
    any_item(document, choices)["shape"] = {"type": "csg", "tree": tree}
    return dumped(document)


trees: dict[str, Callable[[random.Random], bytes]] = {
    "deep": _deep,
    "within": _within,
    "cycle": _cycle,
    "wide": _wide,
    "twice": _twice,
    "unknown": _unknown,
    "CSG bomb": _csg,
}
