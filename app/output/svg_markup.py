"""Text, names and numbers as they may stand in an SVG file."""

from __future__ import annotations

import re

# Characters that XML 1.0 cannot say, however they are written.
_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_UNSAFE = re.compile(r"[^A-Za-z0-9.-]")

_ENTITIES = str.maketrans(
    {
        "&": "&amp;",
        "<": "&lt;",
        ">": "&gt;",
        '"': "&quot;",
        "'": "&#39;",
        "\t": "&#9;",
        "\n": "&#10;",
        "\r": "&#13;",
    }
)


def escaped(text: str) -> str:
    """``text`` for content and attributes; U+FFFD stands for what XML cannot say.

    >>> escaped('<a b="c">')
    '&lt;a b=&quot;c&quot;&gt;'
    """
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", text).translate(_ENTITIES)


def name(prefix: str, text: str) -> str:
    """An XML name for any ``text``, another one for each.

    >>> name("item", "h.a1"), name("item", "h a_1")
    ('item-h.a1', 'item-h_20_a_5f_1')
    """
    return f"{prefix}-" + _UNSAFE.sub(lambda match: f"_{ord(match[0]):x}_", text)


def decimal(value: float) -> str:
    """A number with two decimals at most.

    >>> decimal(2.0), decimal(-0.504), decimal(-0.001)
    ('2', '-.5', '0')
    """
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    if text.startswith("0."):
        return text[1:]
    if text.startswith("-0"):
        return "-" + text[2:] if len(text) > 2 else "0"
    return text
