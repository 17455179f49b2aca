"""Outlines of glyphs as polygons: Bezier curves from the font, flattened and united."""

from __future__ import annotations

import numpy as np
import uharfbuzz as hb
from manifold3d import CrossSection, FillRule

from app.arrays import Floats, Indices

TOLERANCE = 0.004
"""Farthest a polygon may be from its curve, in heights of a capital: 0.4 pixels at 100 pixels."""

LARGEST_TURN = np.radians(30.0)
"""Between neighbouring pieces of one curve, so that small dots stay round."""


def polygons(font: hb.Font, glyph: int, capital: float) -> list[Floats]:
    """Outline of a glyph, its capital H (``capital`` font units high) being 1 high.

    Each polygon is (k, 2), counter-clockwise where it bounds ink, clockwise around a hole;
    polygons do not cross. None for a glyph without ink.
    """
    curves, starts = _curves(font, glyph)
    if len(starts) == 0:
        return []
    contours = _flattened(curves / capital, starts)
    united = CrossSection(contours, FillRule.NonZero).simplify(TOLERANCE / 10)
    return [np.asarray(polygon, dtype=np.float64) for polygon in united.to_polygons()]


def _curves(font: hb.Font, glyph: int) -> tuple[Floats, Indices]:
    """All pieces as cubics (c, 4, 2), and where each contour begins among them."""
    pen = _Pen()
    font.draw_glyph_with_pen(glyph, pen)
    curves = np.array(pen.curves, dtype=np.float64).reshape(-1, 4, 2)
    return curves, np.array(pen.starts, dtype=np.int64)


class _Pen:
    """Writes down what HarfBuzz draws; its method names are those of fontTools' pens."""

    def __init__(self) -> None:
        self.curves: list[tuple[_Point, _Point, _Point, _Point]] = []
        self.starts: list[int] = []
        self._at: _Point = (0.0, 0.0)

    def moveTo(self, point: _Point) -> None:  # noqa: N802 (fontTools' name)
        self.starts.append(len(self.curves))
        self._at = point

    def lineTo(self, point: _Point) -> None:  # noqa: N802 (fontTools' name)
        self._to(self._at, point, point)

    def qCurveTo(self, control: _Point, point: _Point) -> None:  # noqa: N802 (fontTools' name)
        (x0, y0), (x1, y1), (x2, y2) = self._at, control, point
        self._to(
            ((x0 + 2 * x1) / 3, (y0 + 2 * y1) / 3), ((x2 + 2 * x1) / 3, (y2 + 2 * y1) / 3), point
        )

    def curveTo(self, first: _Point, second: _Point, point: _Point) -> None:  # noqa: N802
        self._to(first, second, point)

    def closePath(self) -> None:  # noqa: N802 (fontTools' name)
        """Nothing to do: HarfBuzz has drawn the last line already, and polygons are closed."""

    def _to(self, first: _Point, second: _Point, point: _Point) -> None:
        self.curves.append((self._at, first, second, point))
        self._at = point


_Point = tuple[float, float]


def _flattened(curves: Floats, starts: Indices) -> list[Floats]:
    """Contours as polygons within TOLERANCE of their curves; the last corner is not repeated."""
    pieces = _pieces(curves)
    ends = np.cumsum(pieces)
    curve = np.repeat(np.arange(len(curves)), pieces)
    share = (np.arange(ends[-1]) - np.repeat(ends - pieces, pieces)) / pieces[curve]
    t, s = share[:, None], 1.0 - share[:, None]
    p0, p1, p2, p3 = (curves[curve, corner] for corner in range(4))
    points = s**3 * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t**3 * p3
    return np.split(points, (ends - pieces)[starts[1:]])


def _pieces(curves: Floats) -> Indices:
    """How many chords each cubic needs: Wang's formula, and no sharper turns than allowed."""
    second = np.abs(np.diff(curves, n=2, axis=1))
    bend = np.hypot(second[..., 0], second[..., 1]).max(axis=1)
    by_distance = np.sqrt(0.75 * bend / TOLERANCE)
    first, last = curves[:, 1] - curves[:, 0], curves[:, 3] - curves[:, 2]
    cross = first[:, 0] * last[:, 1] - first[:, 1] * last[:, 0]
    turn = np.abs(np.arctan2(cross, np.einsum("ij,ij->i", first, last)))
    straight = bend < TOLERANCE / 100
    by_turn = np.where(straight, 0.0, turn / LARGEST_TURN)
    pieces: Indices = np.ceil(np.maximum(by_distance, by_turn)).astype(np.int64)
    return np.maximum(pieces, 1, out=pieces)
