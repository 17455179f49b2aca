"""Lines of text beside pictures, in the typefaces that labels are set in."""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from typing import Literal, TypeAlias

import fontpkg
from PIL import ImageDraw, ImageFont

from app.solids.fonts import typefaces

Color: TypeAlias = tuple[int, int, int]

ELLIPSIS = "…"

_FALLBACKS = {
    "inter": ("inter", "noto-sans", "fira-code"),
    "fira-code": ("fira-code", "noto-sans", "inter"),
}
_BREAKS = frozenset(" /,-_:;")
_UNKNOWN = "\N{REPLACEMENT CHARACTER}"


@dataclass(frozen=True, slots=True)
class Type:
    """A typeface at a size in pixels. ``weight`` is 400 for regular, 600 for semi-bold."""

    size: int
    weight: int = 450
    family: Literal["inter", "fira-code"] = "inter"

    def width(self, text: str) -> float:
        """Of a line, in pixels."""
        return sum(_font(run).getlength(part) for run, part in _runs(text, self))

    def fitted(self, text: str, room: float) -> str:
        """As much of a line as there is room for, and an ellipsis where that is not all."""
        if self.width(text) <= room:
            return text
        length = _longest(text, self, room - self.width(ELLIPSIS))
        return text[:length].rstrip() + ELLIPSIS if length else ""

    def wrapped(self, text: str, room: float) -> list[str]:
        """Lines that have room, broken between words, or within what is too long for a line.

        >>> Type(10).wrapped("one two three", 40)
        ['one two', 'three']
        """
        lines: list[str] = []
        while text:
            length = max(_longest(text, self, room), 1)
            if length < len(text) and text[length] != " ":
                # A line that would be left half empty is broken anywhere.
                places = range(length, length // 2, -1)
                length = next((at for at in places if text[at - 1] in _BREAKS), length)
            lines.append(text[:length].rstrip())
            text = text[length:].lstrip()
        return lines


def clean(text: str, most: int) -> str:
    r"""Of any text the first ``most`` characters as one line, without any that hide or reorder.

    >>> clean("a\tb\u202e\x00c", 10)
    'a b c'
    """
    kept = "".join(
        character if character.isprintable() else " "
        for character in text[: 2 * most]
        if unicodedata.category(character) != "Cf"
    )
    line = " ".join(kept.split())
    return line if len(line) <= most and len(text) <= 2 * most else line[:most].rstrip() + ELLIPSIS


def write(
    canvas: ImageDraw.ImageDraw, place: tuple[float, float], text: str, how: Type, color: Color
) -> None:
    """A line whose baseline begins at ``place``."""
    x, y = place
    for run, part in _runs(text, how):
        font = _font(run)
        canvas.text((x, y), part, fill=color, font=font, anchor="ls")
        x += font.getlength(part)


@dataclass(frozen=True, slots=True)
class _Cut:
    """A font file at a weight and size."""

    name: str
    weight: int
    size: int


def _runs(text: str, how: Type) -> Iterator[tuple[_Cut, str]]:
    """Parts of a text, each with the first typeface that has its characters."""
    chosen = ((_name(character, how.family), character) for character in text)
    for name, group in groupby(chosen, key=lambda pair: pair[0]):
        part = "".join(character if name else _UNKNOWN for _, character in group)
        yield _Cut(name or _name(_UNKNOWN, how.family) or how.family, how.weight, how.size), part


@lru_cache(maxsize=4096)
def _name(character: str, family: str) -> str | None:
    coverage = {typeface.name: typeface.coverage for typeface in typefaces()}
    return next((name for name in _FALLBACKS[family] if ord(character) in coverage[name]), None)


def _longest(text: str, how: Type, room: float) -> int:
    """How many characters of a text there is room for."""
    return bisect_right(range(1, len(text) + 1), room, key=lambda end: how.width(text[:end]))


@lru_cache(maxsize=64)
def _font(cut: _Cut) -> ImageFont.FreeTypeFont:
    # Not Raqm, which shapes better, but only where a library is installed.
    font = ImageFont.truetype(
        str(fontpkg.path(cut.name, weight=cut.weight)),
        cut.size,
        layout_engine=ImageFont.Layout.BASIC,
    )
    font.set_variation_by_axes([_setting(axis, cut.weight) for axis in font.get_variation_axes()])
    return font


def _setting(axis: ImageFont.Axis, weight: int) -> float:
    """Of an axis of a variable font."""
    if axis.get("name") != b"Weight":
        return axis["default"] or 0
    return min(max(weight, axis["minimum"] or 0), axis["maximum"] or weight)
