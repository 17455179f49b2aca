"""Type for pictures that are not scenes: captions and error cards."""

from __future__ import annotations

from functools import lru_cache

import fontpkg
from PIL import Image, ImageDraw, ImageFont


@lru_cache(maxsize=64)
def typeface(size: int, weight: int = 400) -> ImageFont.FreeTypeFont:
    """Inter, ``size`` pixels high."""
    font = ImageFont.truetype(str(fontpkg.path("inter", weight=weight)), size)
    font.set_variation_by_axes([min(max(size, 14), 32), weight])
    return font


def shortened(text: str, font: ImageFont.FreeTypeFont, width: float) -> str:
    """As much of the beginning as fits, with an ellipsis if that is not all."""
    text = printable(text)
    if font.getlength(text) <= width:
        return text
    low, high = 0, min(len(text), 2000)
    while low < high:
        middle = (low + high + 1) // 2
        if font.getlength(text[:middle] + "…") <= width:
            low = middle
        else:
            high = middle - 1
    return text[:low] + "…"


def wrapped(text: str, font: ImageFont.FreeTypeFont, width: float, most: int) -> list[str]:
    """Lines no wider than ``width``, at most so many; broken within words that are too long."""
    lines: list[str] = []
    line = ""
    for word in printable(text)[:4000].split():
        longer = f"{line} {word}".strip()
        if font.getlength(longer) <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        line = word
        while font.getlength(line) > width and len(line) > 1:
            fitting = len(shortened(line, font, width)) - 1
            lines.append(line[: max(fitting, 1)])
            line = line[max(fitting, 1) :]
        if len(lines) > most:
            break
    lines.append(line)
    if len(lines) > most:
        lines = [*lines[: most - 1], shortened(lines[most - 1] + " …………", font, width)]
    return lines


def printable(text: str) -> str:
    """Without what would break a line or turn it around."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def draw_line(
    picture: Image.Image,
    place: tuple[float, float],
    text: str,
    font: ImageFont.FreeTypeFont,
    color: str,
    anchor: str = "la",
) -> None:
    """One line of text, ``anchor`` as Pillow has it."""
    ImageDraw.Draw(picture).text(place, text, fill=color, font=font, anchor=anchor)
