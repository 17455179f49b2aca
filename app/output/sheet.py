"""Many pictures on one sheet: with captions under them, or headings over and beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PIL import Image, ImageColor, ImageDraw

from app.output.lettering import Color, Type, clean, write

INK, FADED, RULE = 0.15, 0.42, 0.86
"""Lightness of titles, captions and rules on white; on black it is the other way round."""

LONGEST_TEXT = 200

WIDEST_NAMES = 0.14
"""Share of the sheet's width that the names of rows may take."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of ``width`` by ``height`` pixels with places for pictures in rows and columns.

    ``background`` is an sRGB colour (#rgb or #rrggbb). Where it ``names_rows``, a name stands
    beside each row, and one over each column; else there is a caption under each picture. What
    there is no room for is shortened.
    """

    width: int
    height: int
    rows: int
    columns: int
    background: str = "#ffffff"
    names_rows: bool = False
    title: str | None = None

    @property
    def cell(self) -> tuple[int, int]:
        """Width and height of each picture, in pixels."""
        across = self.width - 2 * self._margin - self._beside - (self.columns - 1) * self._gap
        upright = self.height - self._top - self._margin - (self.rows - 1) * self._gap
        return max(across // self.columns, 1), max(upright // self.rows - self._under, 1)

    def of(
        self, pictures: Sequence[Image.Image], captions: Sequence[str], names: Sequence[str] = ()
    ) -> Image.Image:
        """The sheet with its pictures, row by row, each of the size of a `cell`.

        Each has its caption. Where the sheet names its rows, those of the first row are the names
        of the columns, and ``names`` those of the rows.
        """
        paper: Color = ImageColor.getrgb(self.background)[:3]
        sheet = Image.new("RGB", (self.width, self.height), paper)
        canvas = ImageDraw.Draw(sheet)
        dark = sum(paper) < 3 * 110
        ink, faded, rule = (_grey(1 - tone if dark else tone) for tone in (INK, FADED, RULE))
        if self.title:
            how, margin = self._large, self._margin
            line = how.fitted(clean(self.title, LONGEST_TEXT), self.width - 2 * margin)
            write(canvas, (margin, margin + round(0.85 * how.size)), line, how, ink)
        self._rule(canvas, rule)
        for number, picture in enumerate(pictures):
            mask = picture.getchannel("A") if picture.mode == "RGBA" else None
            sheet.paste(picture.convert("RGB"), self._place(number), mask)
        if self.names_rows:
            self._name_columns(canvas, captions[: self.columns], faded)
            self._name_rows(canvas, names[: self.rows], faded)
        else:
            self._caption(canvas, captions[: len(pictures)], faded)
        return sheet

    @property
    def _small(self) -> Type:
        return Type(min(max(min(self.width, self.height) // 45, 10), 28))

    @property
    def _large(self) -> Type:
        return Type(round(1.5 * self._small.size), weight=600)

    @property
    def _margin(self) -> int:
        return round(1.4 * self._small.size)

    @property
    def _gap(self) -> int:
        return 2 * (self._small.size // 2) + 1

    @property
    def _under(self) -> int:
        return 0 if self.names_rows else 2 * self._small.size

    @property
    def _beside(self) -> int:
        return round(WIDEST_NAMES * self.width) if self.names_rows else 0

    @property
    def _top(self) -> int:
        """Where the pictures begin."""
        title = 2 * self._large.size if self.title else 0
        return self._margin + title + (2 * self._small.size if self.names_rows else 0)

    def _place(self, number: int) -> tuple[int, int]:
        """Left and top of a picture."""
        row, column = divmod(number, self.columns)
        width, height = self.cell
        return (
            self._margin + self._beside + column * (width + self._gap),
            self._top + row * (height + self._under + self._gap),
        )

    def _rule(self, canvas: ImageDraw.ImageDraw, color: Color) -> None:
        """Thin lines between columns and between rows, each in the middle of its gap."""
        (left, top), half = self._place(0), self._gap // 2 + 1
        width, height = self.cell
        last = self._place(self.rows * self.columns - 1)
        right, bottom = last[0] + width - 1, last[1] + height + self._under - 1
        first = 0 if self.names_rows else 1
        for column in range(first, self.columns):
            x = self._place(column)[0] - half
            canvas.line((x, top, x, bottom), fill=color)
        for row in range(first, self.rows):
            y = self._place(row * self.columns)[1] - half
            canvas.line((left, y, right, y), fill=color)

    def _caption(self, canvas: ImageDraw.ImageDraw, captions: Sequence[str], color: Color) -> None:
        small, (width, height) = self._small, self.cell
        for number, caption in enumerate(captions):
            text = small.fitted(clean(caption, LONGEST_TEXT), width)
            left, top = self._place(number)
            write(canvas, (left, top + height + round(1.35 * small.size)), text, small, color)

    def _name_columns(
        self, canvas: ImageDraw.ImageDraw, names: Sequence[str], color: Color
    ) -> None:
        small, (width, _) = self._small, self.cell
        for column, name in enumerate(names):
            text = small.fitted(clean(name, LONGEST_TEXT), width)
            left, top = self._place(column)
            x = left + (width - small.width(text)) / 2
            write(canvas, (x, top - round(1.05 * small.size)), text, small, color)

    def _name_rows(self, canvas: ImageDraw.ImageDraw, names: Sequence[str], color: Color) -> None:
        small, (_, height) = self._small, self.cell
        for row, name in enumerate(names):
            lines = _in_lines(name)
            middle = self._place(row * self.columns)[1] + height / 2
            for number, line in enumerate(lines):
                y = middle + (0.35 + 1.4 * (number - (len(lines) - 1) / 2)) * small.size
                text = small.fitted(line, self._beside - self._gap)
                write(canvas, (self._margin, y), text, small, color)


def _in_lines(name: str) -> list[str]:
    """A parameter over its value, to be narrow."""
    parameter, equals, value = clean(name, LONGEST_TEXT).partition(" = ")
    return [parameter, value] if equals else [parameter]


def _grey(lightness: float) -> Color:
    value = round(255 * lightness)
    return value, value, value
