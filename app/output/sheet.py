"""Pictures beside each other on one sheet, with captions, rows and columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PIL import Image

from app.output.lettering import draw_line, shortened, typeface

LIGHT, DARK = "#5a6472", "#c8d0da"


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet of ``width`` by ``height`` pixels with cells for ``rows`` by ``columns`` pictures.

    ``background`` is ``#rrggbb``. Rows are named if ``names_rows``.
    """

    width: int
    height: int
    rows: int
    columns: int
    background: str
    names_rows: bool = False

    @property
    def type_size(self) -> int:
        """Pixels: legible, and small beside the pictures."""
        return min(max(self.height // (self.rows * 22), 9), 22)

    @property
    def cell(self) -> tuple[int, int]:
        """Width and height of one picture."""
        width = (self.width - self._aside - self._gap * (self.columns + 1)) // self.columns
        height = (self.height - self._gap * (self.rows + 1)) // self.rows - self._caption
        return max(width, 1), max(height, 1)

    def of(
        self, pictures: Sequence[Image.Image], captions: Sequence[str], rows: Sequence[str] = ()
    ) -> Image.Image:
        """All pictures, row by row, each over its caption; names of rows stand at their left."""
        sheet = Image.new("RGB", (self.width, self.height), self.background)
        font = typeface(self.type_size, 500)
        ink = LIGHT if sum(_paper(sheet)) > 384 else DARK
        width, height = self.cell
        for number, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
            row, column = divmod(number, self.columns)
            left = self._aside + self._gap + column * (width + self._gap)
            top = self._gap + row * (height + self._caption + self._gap)
            sheet.paste(picture.convert("RGB"), (left, top))
            place = left + width / 2, top + height + self._caption / 2
            draw_line(sheet, place, shortened(caption, font, width), font, ink, "mm")
            if column == 0 and row < len(rows):
                name = shortened(rows[row], font, height)
                draw_upright(sheet, name, self.type_size, ink, self._aside, top + height / 2)
        return sheet

    @property
    def _gap(self) -> int:
        return max(self.type_size // 2, 3)

    @property
    def _caption(self) -> int:
        return round(1.6 * self.type_size)

    @property
    def _aside(self) -> int:
        return 2 * self.type_size if self.names_rows else 0


def draw_upright(
    sheet: Image.Image, text: str, size: int, ink: str, width: int, middle: float
) -> None:
    """A line that reads upward, in the strip of ``width`` at the left."""
    font = typeface(size, 500)
    size_of_strip = max(round(font.getlength(text)), 1) + 4, width
    strip = Image.new("RGB", size_of_strip, _paper(sheet))
    draw_line(strip, (strip.width / 2, width / 2), text, font, ink, "mm")
    turned = strip.transpose(Image.Transpose.ROTATE_90)
    sheet.paste(turned, (0, round(middle - turned.height / 2)))


def _paper(sheet: Image.Image) -> tuple[int, int, int]:
    red, green, blue = sheet.convert("RGB").tobytes()[:3]
    return red, green, blue
