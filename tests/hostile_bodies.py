"""Bodies that are no documents, or documents whose values are impossible."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from typing import Any

from tests.hostile_parts import any_hyperedge, any_item, base, dumped

MEGABYTE = 1_000_000


def _no_json(choices: random.Random) -> bytes:
    good = dumped(base(choices))
    return choices.choice(
        (
            b"",
            b" \n\t ",
            b"\x00" * 100,
            choices.randbytes(1000),
            b"<?xml version='1.0'?><!DOCTYPE x [<!ENTITY a 'b'>]><x>&a;</x>",
            b"\x89PNG\r\n\x1a\n" + choices.randbytes(100),
            b"PK\x03\x04" + choices.randbytes(100),
            b"\x80\x04\x95" + choices.randbytes(50),  # a pickle's beginning
            good[: choices.randrange(1, len(good) - 1)],
            good + good,
            good.replace(b'"', b"'"),
            good.replace(b"}", b",}", 1),
            good.replace(b"{", b"{/* */", 1),
            b")]}'\n" + good,
            good.decode().encode("utf-16"),
            good.decode().encode("utf-32"),
            good[:-1] + b"\x00}",
            good.replace(
                b"0.05", choices.choice((b"0x10", b"01", b"1.", b".5", b"+1", b"1e", b"--1"))
            ),
            good.replace(b"0.05", choices.choice((b"True", b"None", b"undefined", b"nul"))),
        )
    )


def _no_object(choices: random.Random) -> bytes:
    return choices.choice((b"null", b"true", b"0", b'"text"', b"[]", b"[{}]", b"{}", b"[[[[]]]]"))


def _no_number(choices: random.Random) -> bytes:
    token = choices.choice(("NaN", "Infinity", "-Infinity", "nan", "inf", "1e999", "-1e999"))
    return _with_number(choices, token)


def _huge_number(choices: random.Random) -> bytes:
    token = choices.choice(
        (
            "1e308",
            "-1e308",
            "1e7",
            "1" * 400,
            "-" + "9" * 4000,
            "9" * 100_000,
            "0." + "0" * 100_000 + "1e400000",
            "1e" + "9" * 1000,
            "123456789012345678901234567890",
        )
    )
    return _with_number(choices, token)


def _with_number(choices: random.Random, token: str) -> bytes:
    """A document with ``token`` where a coordinate or a length stands."""
    document = base(choices)
    item, mark = any_item(document, choices), 987654.321
    match choices.randrange(6):
        case 0:
            item["position"][choices.randrange(3)] = mark
        case 1:
            item["shape"]["size"][choices.randrange(3)] = mark
        case 2:
            item["rotation"][choices.randrange(3)] = mark
        case 3:
            any_hyperedge(document, choices)["radius"] = mark
        case 4:
            document["layout"]["clearance"] = mark
        case _:
            item["attachment_points"][0]["position"][choices.randrange(3)] = mark
    return dumped(document).replace(str(mark).encode(), token.encode())


def _unicode(choices: random.Random) -> bytes:
    document = base(choices)
    item, hyperedge = any_item(document, choices), any_hyperedge(document, choices)
    trick = choices.choice(TRICKS)
    match choices.randrange(7):
        case 0:  # half a pair of surrogates, escaped
            half = f"\\u{choices.randrange(0xD800, 0xE000):04x}".encode()
            return dumped(document).replace(item["label"].encode(), half, 1)
        case 1:  # bytes that are no UTF-8: overlong, surrogates, beyond the last, cut off
            bytes_ = choices.choice(BAD_BYTES)
            return dumped(document).replace(item["label"].encode(), bytes_, 1)
        case 2:  # a key that only looks like one
            item[trick + "label"] = "x"
        case 3:  # a reference that only looks like one
            hyperedge["attachments"][0]["item"] += trick
        case 4:  # a name of ours that only looks like one
            item["material"] = "pl\u0430stic"
        case 5:
            item["color"] = "#" + choices.choice(
                ("\uff11\uff12\uff13", "12\u200b3", "١٢٣", "fff\n")
            )
        case _:
            item["shape"]["type"] = "box" + trick
    return dumped(document)


TRICKS = (
    "\u202e",  # right-to-left override
    "\u2066",
    "\u200b",  # zero width space
    "\u200d" * 500,
    "\ufeff",
    "\u0301" * 1000,  # accents above each other
    "\U000e0041",  # tags
    "\u0000",
    "\x1b[2J",
    "\ufdfd" * 100,
    "\U0010ffff",
    "\u2028",
)

BAD_BYTES = (
    b"\xc0\xaf",
    b"\xe0\x80\xaf",
    b"\xf0\x80\x80\xaf",
    b"\xed\xa0\x80",
    b"\xed\xa0\x80\xed\xb0\x80",
    b"\xf4\x90\x80\x80",
    b"\xf8\x88\x80\x80\x80",
    b"\xc3",
    b"\xff\xfe",
    b"\x80",
)

_WRONG: tuple[Any, ...] = (
    True,
    0,
    -1,
    1.5,
    "text",
    "",
    [],
    {},
    [[]],
    [None],
    {"type": "nothing"},
    [1, 2],
    {"$ref": "#/items/0"},
    {"__proto__": {}},
)


def _wrong_type(choices: random.Random) -> bytes:
    document = base(choices)
    places = list(_places(document))
    for _ in range(choices.choice((1, 1, 1, 3, 20))):
        holder, key = choices.choice(places)
        was = holder[key]
        wrong = [each for each in _WRONG if not _might_pass(was, each)]
        holder[key] = choices.choice(wrong)
    return dumped(document)


def _places(value: Any) -> Any:
    """Every value in ``value``, as what holds it and its key."""
    entries = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, inner in list(entries):
        yield value, key
        yield from _places(inner)


def _might_pass(was: Any, wrong: Any) -> bool:
    if isinstance(was, int | float) and not isinstance(was, bool):
        return isinstance(wrong, int | float) and not isinstance(wrong, bool)
    if isinstance(was, list) and not was:
        return bool(wrong == [])
    # An empty list may be right for items; texts may be right for texts.
    return type(was) is type(wrong)


def _huge_string(choices: random.Random) -> bytes:
    document = base(choices)
    size = choices.choice((501, 10_000, MEGABYTE, 10 * MEGABYTE))
    text = choices.choice(("x", "é", "\U0001f4a3", "\\u0041"))
    long = text * (size // len(text) + 1)
    item = any_item(document, choices)
    match choices.randrange(7):
        case 0:
            item["id"] = long
        case 1:
            item["label"] = long
        case 2:
            item["kind"] = long
        case 3:
            document["notation"] = long
        case 4:
            item["color"] = "#" + long
        case 5:
            any_hyperedge(document, choices)["attachments"][0]["item"] = long
        case _:
            item[long] = 1
    return dumped(document)


def _too_large(choices: random.Random) -> bytes:
    size = choices.choice((33_600_000, 40 * MEGABYTE))
    return choices.choice((b" ", b"[", b"9", b'"', b"\x00")) * size


def _labels(choices: random.Random) -> bytes:
    document = base(choices)
    amount = choices.choice((250, 1000, 5000))
    text = choices.choice(("W", "\u8f9e", "\u0646\u0651", "q\u0301", "\U0001f469\u200d\U0001f4bb"))
    label = text * (500 // len(text))
    document["items"] += [{"id": f"l{number}", "label": label} for number in range(amount)]
    return dumped(document)


bodies: dict[str, Callable[[random.Random], bytes]] = {
    "no JSON": _no_json,
    "no object": _no_object,
    "no number": _no_number,
    "huge number": _huge_number,
    "Unicode": _unicode,
    "wrong type": _wrong_type,
    "huge string": _huge_string,
    "too large": _too_large,
    "label bomb": _labels,
}


def repeated_key(document: dict[str, Any], choices: random.Random) -> bytes:
    """A document in which one key stands twice."""
    key = choices.choice(("items", "name", "hyperedges"))
    again = json.dumps(document[key])
    return dumped(document)[:-1] + f', "{key}": {again}}}'.encode()
