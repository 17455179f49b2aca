"""Pictures that say what is seen at each pixel, without light or colour (Numba)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from app.arrays import Floats, Indices
from app.readability.projection import Seen

NOTHING = -1
"""The number of what has nothing before it."""

MARGIN = 1.0
"""Free pixels at the picture's edges."""

THINNEST = 0.75
"""Half the width of lines, in pixels, at least: so that each is seen in all pixels along it."""


class Picture(NamedTuple):
    """``numbers`` (rows, columns) of what is seen, and its ``nearness`` (rows, columns).

    A place of the picture is at the pixel ``scale`` * (place - ``corner``), with columns to the
    right and rows upwards; ``corner`` (2,).
    """

    numbers: Indices
    nearness: Floats
    corner: Floats
    scale: float

    def pixels(self, places: Floats) -> Floats:
        """Where ``places`` (n, 2) are, (n, 2), as columns and rows; pixels' middles are halves."""
        return np.ascontiguousarray(self.scale * (places - self.corner))


def empty_picture(low: Floats, high: Floats, longest: int) -> Picture:
    """A picture of all between two corners (2,); its longer side has ``longest`` pixels."""
    size = high - low
    scale = (longest - 2 * MARGIN) / max(float(size.max()), 1e-12)
    columns, rows = np.clip(np.ceil(scale * size + 2 * MARGIN), 1, longest).astype(np.int64)
    return Picture(
        np.full((rows, columns), NOTHING),
        np.full((rows, columns), -np.inf),
        low - MARGIN / scale,
        scale,
    )


def paint_capsules(
    picture: Picture,
    begins: Seen,
    ends: Seen,
    fronts: tuple[Floats, Floats],
    radii: Floats,
    numbers: Indices,
) -> None:
    """Paint balls of ``radii`` (n,), document units, that move from ``begins`` to ``ends``.

    ``fronts`` (n,) say how near the nearest places of both balls are. They are seen as ``numbers``
    (n,).
    """
    _paint_capsules(
        picture.numbers,
        picture.nearness,
        picture.pixels(begins.places),
        picture.pixels(ends.places),
        np.stack([begins.nearness, ends.nearness], axis=1),
        np.stack(fronts, axis=1),
        picture.scale * radii * np.maximum(begins.scales, ends.scales),
        numbers,
    )


def paint_triangles(picture: Picture, corners: Seen, numbers: Indices) -> None:
    """Paint triangles, of which ``corners`` has three each; they are seen as ``numbers`` (n,)."""
    _paint_triangles(
        picture.numbers,
        picture.nearness,
        picture.pixels(corners.places).reshape(-1, 3, 2),
        corners.nearness.reshape(-1, 3),
        numbers,
    )


@njit(cache=True, error_model="numpy", inline="always")
def _range(low: float, high: float, count: int) -> tuple[int, int]:
    """Pixels whose middles may lie between two places of a row or column of so many."""
    first = int(min(max(np.floor(low - 0.5), 0.0), count))
    last = int(min(max(np.ceil(high + 0.5), 0.0), count))
    return first, last


@njit(cache=True, error_model="numpy", nogil=True)
def _paint_capsules(
    seen: Indices,
    nearness: Floats,
    begins: Floats,
    ends: Floats,
    middles: Floats,
    fronts: Floats,
    radii: Floats,
    numbers: Indices,
) -> None:
    rows, columns = seen.shape
    for k in range(len(numbers)):
        ax, ay = begins[k]
        x, y = ends[k, 0] - ax, ends[k, 1] - ay
        radius = max(radii[k], THINNEST)
        square = x * x + y * y
        left, right = _range(min(ax, ax + x) - radius, max(ax, ax + x) + radius, columns)
        bottom, top = _range(min(ay, ay + y) - radius, max(ay, ay + y) + radius, rows)
        for row in range(bottom, top):
            for column in range(left, right):
                px, py = column + 0.5 - ax, row + 0.5 - ay
                share = 0.0
                if square > 0.0:
                    share = min(max((px * x + py * y) / square, 0.0), 1.0)
                far = ((px - share * x) ** 2 + (py - share * y) ** 2) / (radius * radius)
                if far > 1.0:
                    continue
                middle = middles[k, 0] + share * (middles[k, 1] - middles[k, 0])
                front = fronts[k, 0] + share * (fronts[k, 1] - fronts[k, 0])
                near = middle + np.sqrt(1.0 - far) * (front - middle)
                if near > nearness[row, column]:
                    nearness[row, column] = near
                    seen[row, column] = numbers[k]


@njit(cache=True, error_model="numpy", nogil=True)
def _paint_triangles(
    seen: Indices, nearness: Floats, corners: Floats, nearnesses: Floats, numbers: Indices
) -> None:
    rows, columns = seen.shape
    for k in range(len(numbers)):
        (ax, ay), (bx, by), (cx, cy) = corners[k, 0], corners[k, 1], corners[k, 2]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0:
            continue
        left, right = _range(min(ax, bx, cx), max(ax, bx, cx), columns)
        bottom, top = _range(min(ay, by, cy), max(ay, by, cy), rows)
        for row in range(bottom, top):
            for column in range(left, right):
                x, y = column + 0.5, row + 0.5
                a = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                b = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                c = 1.0 - a - b
                if a < 0.0 or b < 0.0 or c < 0.0:
                    continue
                near = a * nearnesses[k, 0] + b * nearnesses[k, 1] + c * nearnesses[k, 2]
                if near > nearness[row, column]:
                    nearness[row, column] = near
                    seen[row, column] = numbers[k]
