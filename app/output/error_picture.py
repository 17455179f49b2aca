"""What went wrong as a picture: a calm card that can be read wherever it is embedded."""

from __future__ import annotations

import io
from collections.abc import Sequence
from xml.sax.saxutils import escape

from PIL import Image, ImageDraw

from app.output.lettering import draw_line, typeface, wrapped

PAPER, EDGE, INK, QUIET, MARK = "#ffffff", "#d8dee6", "#1f2933", "#5a6472", "#c2410c"


def error_picture(
    title: str, lines: Sequence[str], width: int, height: int, *, as_svg: bool
) -> bytes:
    """A card of ``width`` by ``height`` pixels, as PNG or SVG; what does not fit is counted."""
    size = min(max(round(min(width / 26, height / 14)), 9), 26)
    margin = round(1.4 * size)
    room = width - 2 * margin - size
    step = round(1.5 * size)
    most = max((height - 2 * margin - 2 * step) // step, 1)
    texts = [(line, INK) for line in wrapped(title, typeface(round(1.15 * size), 600), room, 2)]
    body = [line for text in lines[:50] for line in wrapped(text, typeface(size), room, 4)]
    if len(body) > most:
        left = len(lines) - 1 if most < 2 else len(body) - most + 1
        body = [*body[: most - 1], f"… and {left} more"]
    texts += [(line, QUIET) for line in body]
    write = _svg if as_svg else _png
    return write(texts, width, height, size, margin, step)


Texts = Sequence[tuple[str, str]]


def _png(texts: Texts, width: int, height: int, size: int, margin: int, step: int) -> bytes:
    card = Image.new("RGB", (width, height), PAPER)
    pen = ImageDraw.Draw(card)
    pen.rectangle((0, 0, width - 1, height - 1), outline=EDGE)
    pen.rectangle((margin, margin, margin + max(size // 4, 2), height - margin), fill=MARK)
    for number, (text, color) in enumerate(texts):
        font = typeface(round(1.15 * size), 600) if color == INK else typeface(size)
        draw_line(card, (margin + size, margin + number * step), text, font, color)
    file = io.BytesIO()
    card.save(file, "PNG")
    return file.getvalue()


def _svg(texts: Texts, width: int, height: int, size: int, margin: int, step: int) -> bytes:
    rows = "".join(
        f'<text x="{margin + size}" y="{margin + number * step + size}" fill="{color}"'
        f' font-weight="{600 if color == INK else 400}">{escape(text)}</text>'
        for number, (text, color) in enumerate(texts)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"'
        f' viewBox="0 0 {width} {height}" role="img" font-size="{size}"'
        ' font-family="Inter, system-ui, sans-serif">'
        f'<rect width="{width}" height="{height}" fill="{PAPER}" stroke="{EDGE}"/>'
        f'<rect x="{margin}" y="{margin}" width="{max(size // 4, 2)}"'
        f' height="{max(height - 2 * margin, 1)}" fill="{MARK}"/>{rows}</svg>\n'
    ).encode()
