"""Faults as a picture, for pages that embed what we draw and would show a broken image instead."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

from PIL import Image, ImageDraw

from app.output.lettering import ELLIPSIS, Color, Type, clean, write

PAPER, CARD, EDGE = (244, 244, 241), (255, 255, 255), (222, 222, 217)
INK, SOFT, ACCENT = (34, 34, 38), (96, 96, 102), (190, 76, 60)

LONGEST_TITLE, LONGEST_LINE = 200, 600

FAMILIES = {
    "inter": "Inter, 'Helvetica Neue', Arial, 'Noto Sans', sans-serif",
    "fira-code": "'Fira Code', Menlo, Consolas, 'Noto Sans Mono', monospace",
}
NARROWER = 0.86
"""Share of the room that text in SVG is set for: the reader's typefaces may be wider than ours."""


@dataclass(frozen=True, slots=True)
class _Line:
    """Text whose baseline begins at (x, y)."""

    x: int
    y: int
    text: str
    how: Type
    color: Color


@dataclass(frozen=True, slots=True)
class _Card:
    """Where things stand in a picture of ``width`` by ``height`` pixels, by the size of letters."""

    width: int
    height: int

    @property
    def letters(self) -> int:
        """Size of the text: legible in a thumbnail, not shouting in a poster."""
        return min(max(min(self.width // 38, self.height // 22), 10), 30)

    @property
    def margin(self) -> int:
        """Around the card."""
        return min(round(1.4 * self.letters), self.width // 16, self.height // 12)

    @property
    def padding(self) -> int:
        """Within the card; more on the left, where the accent is."""
        return max(round(0.9 * self.letters), 4)

    @property
    def left(self) -> int:
        """Where text begins."""
        return self.margin + round(1.5 * self.padding)

    @property
    def room(self) -> int:
        """Width of the text."""
        return max(self.width - self.left - self.margin - self.padding, 1)


def error_picture(title: str, lines: Sequence[str], width: int, height: int, as_svg: bool) -> bytes:
    """A calm card with a title and the faults, as PNG or as SVG of ``width`` by ``height`` pixels.

    A line may begin with a JSON pointer and a colon. Lines are wrapped; how many there is no room
    for is said. Text comes from anywhere: what is not printable is left out.
    """
    card = _Card(width, height)
    written = list(_written(card, title, lines, NARROWER if as_svg else 1.0))
    return _svg(card, written) if as_svg else _png(card, written)


def _written(card: _Card, title: str, lines: Sequence[str], share: float) -> Iterator[_Line]:
    room = share * card.room
    bottom = card.height - card.margin - card.padding
    heading = Type(round(1.3 * card.letters), weight=600)
    text, mono = Type(card.letters), Type(card.letters, family="fira-code")
    y = card.margin + card.padding
    wrapped = heading.wrapped(clean(title, LONGEST_TITLE), room)
    most = max((bottom - y) // (2 * round(1.3 * heading.size)), 1)
    for number, line in enumerate(wrapped[:most]):
        y += round((1.0 if number == 0 else 1.25) * heading.size)
        is_cut = number == most - 1 < len(wrapped) - 1
        shown = heading.fitted(line + ELLIPSIS, room) if is_cut else line
        yield _Line(card.left, y, shown, heading, INK)
    y += round(0.35 * text.size)
    step = round(1.4 * text.size)
    for number, line in enumerate(lines):
        block = _block(clean(line, LONGEST_LINE), room, text, mono)
        left = len(lines) - number - 1
        places = (bottom - y) // step
        if left == 0 and len(block) > places > 0:
            block = [*block[: places - 1], _cut_short(block[places - 1], room)]
        elif len(block) > places - (1 if left else 0):
            if places > 0:
                more = f"and {left + 1} more" if number else _counted(left + 1)
                yield _Line(card.left, y + step, more, text, SOFT)
            return
        for what, how, color in block:
            y += step
            yield _Line(card.left, y, what, how, color)
        y += round(0.35 * text.size)


_Piece = tuple[str, Type, Color]


def _block(line: str, room: float, text: Type, mono: Type) -> list[_Piece]:
    """A fault: its pointer, where it has one, and what is wrong."""
    pointer, colon, detail = line.partition(": ")
    if not (colon and pointer.startswith("/") and " " not in pointer):
        return [(part, text, SOFT) for part in text.wrapped(line, room)]
    return [
        *((part, mono, ACCENT) for part in mono.wrapped(pointer, room)),
        *((part, text, SOFT) for part in text.wrapped(detail, room)),
    ]


def _cut_short(piece: _Piece, room: float) -> _Piece:
    what, how, color = piece
    return how.fitted(what + " " + ELLIPSIS, room), how, color


def _counted(count: int) -> str:
    return "1 fault" if count == 1 else f"{count} faults"


def _png(card: _Card, written: Sequence[_Line]) -> bytes:
    # Twice as large and made smaller, for round corners without steps; text is smooth by itself.
    twice = Image.new("RGB", (2 * card.width, 2 * card.height), PAPER)
    canvas = ImageDraw.Draw(twice)
    left, top, right, bottom = (2 * side for side in _frame(card))
    radius = card.padding
    canvas.rounded_rectangle((left, top, right - 1, bottom - 1), radius, CARD, EDGE, 2)
    bar = (left, top, left + max(card.padding // 2, 4) - 1, bottom - 1)
    canvas.rounded_rectangle(bar, radius, ACCENT, corners=(True, False, False, True))
    picture = twice.resize((card.width, card.height), Image.Resampling.BOX)
    canvas = ImageDraw.Draw(picture)
    for line in written:
        write(canvas, (line.x, line.y), line.text, line.how, line.color)
    buffer = io.BytesIO()
    picture.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _svg(card: _Card, written: Sequence[_Line]) -> bytes:
    left, top, right, bottom = _frame(card)
    bar, radius = max(card.padding // 4, 2), card.padding / 2
    whole, inner = card.width, right - left
    head = f'width="{whole}" height="{card.height}" viewBox="0 0 {whole} {card.height}"'
    edge = f'width="{inner - 1}" height="{bottom - top - 1}" rx="{radius}" stroke="{_hex(EDGE)}"'
    accent = f'width="{bar}" height="{bottom - top}" rx="{bar / 2}" fill="{_hex(ACCENT)}"'
    pieces = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {head}>',
        f'<rect width="{whole}" height="{card.height}" fill="{_hex(PAPER)}"/>',
        f'<rect x="{left + 0.5}" y="{top + 0.5}" fill="{_hex(CARD)}" {edge}/>',
        f'<rect x="{left}" y="{top}" {accent}/>',
        *map(_text, written),
        "</svg>",
    ]
    return "\n".join(pieces).encode()


def _text(line: _Line) -> str:
    how = line.how
    font = f'font-family="{FAMILIES[how.family]}" font-size="{how.size}"'
    look = f'font-weight="{how.weight}" fill="{_hex(line.color)}"'
    return f'<text x="{line.x}" y="{line.y}" {font} {look}>{escape(line.text)}</text>'


def _frame(card: _Card) -> tuple[int, int, int, int]:
    margin = card.margin
    return margin, margin, card.width - margin, card.height - margin


def _hex(color: Color) -> str:
    return "#" + bytes(color).hex()
