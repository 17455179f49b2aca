"""How high items stand around each place: what is deep among them sees little of the sky."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from app.arrays import Faces, Floats, Singles
from app.output.draft_scene import DraftScene

TEXELS = 128
"""What it holds is blurred over the width of an item: more would not be seen."""

BLURS = 0.25, 0.8
"""How far the near and the wide darkness beside an item go, in shares of the scene's reach."""

UPRIGHT = 3.0
"""What is so many times as wide and as high as it is deep, stands upright."""

_MARGIN = 3.0
"""Of so many times that reach around all items."""

_TRUNCATION = 4.0
"""So many deviations from its middle, a bell is as good as nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Heights:
    """Heights (TEXELS, TEXELS, 2) of the surroundings, near and wide, from low y to high.

    ``matrix`` (4, 4) turns places in the draft to places there, from 0 to 1.
    """

    values: Singles
    matrix: Floats


def heights(scene: DraftScene) -> Heights | None:
    """Of the scene's items; ``None`` where they are none, or stand one above another."""
    if scene.reach <= 0.0 or _is_upright(scene):
        return None
    # By twos, so that each texel is a mean of four.
    fine = np.full((2 * TEXELS, 2 * TEXELS), scene.floor, dtype=np.float32)
    parts = [part for part in scene.sections if part.shows == "item"]
    around = scene.boxes[scene.is_item, :, :2]
    low, high = around[:, 0].min(axis=0), around[:, 1].max(axis=0)
    low, extent = low - _MARGIN * scene.reach, high - low + 2 * _MARGIN * scene.reach
    scale = 2 * TEXELS / extent
    for part in parts:
        faces = scene.faces[part.first : part.first + part.count]
        _raise(fine, scene.positions, faces, low, scale)
    coarse = fine.reshape(TEXELS, 2, TEXELS, 2).mean(axis=(1, 3))
    width = scene.reach * TEXELS / extent[::-1]
    blurred = [_blurred(coarse, share * width) for share in BLURS]
    matrix = np.zeros((4, 4))
    matrix[[0, 1], [0, 1]] = 1 / extent
    matrix[:2, 3] = -low / extent
    return Heights(np.stack(blurred, axis=-1), matrix)


def _is_upright(scene: DraftScene) -> bool:
    """Whether items are in an upright plane: each would darken all that is below it."""
    around = scene.boxes[scene.is_item]
    width, depth, height = around[:, 1].max(axis=0) - around[:, 0].min(axis=0)
    tallest = (around[:, 1, 2] - around[:, 0, 2]).max()
    return bool(UPRIGHT * depth < min(width, height) and height > 1.5 * tallest)


def _blurred(grid: Singles, deviations: Floats) -> Singles:
    """The grid after a Gaussian blur of these ``deviations``, by rows and by columns in cells."""
    # SciPy has this, but takes as long to import as all of NumPy and Numba do.
    down, across = (_weights(deviation) for deviation in deviations)
    return (down @ grid @ across.T).astype(np.float32)


def _weights(deviation: float) -> Floats:
    """What each of TEXELS cells in a row takes from every other; the last go on for ever."""
    reach = round(_TRUNCATION * deviation)
    steps = np.arange(-reach, reach + 1)
    bell = np.exp(-0.5 * (steps / deviation) ** 2)
    cells = np.arange(TEXELS)[:, None]
    weights = np.zeros((TEXELS, TEXELS))
    np.add.at(weights, (cells, np.clip(cells + steps, 0, TEXELS - 1)), bell / bell.sum())
    return weights


@njit(cache=True, nogil=True, error_model="numpy")
def _raise(grid: Singles, positions: Singles, faces: Faces, low: Floats, scale: Floats) -> None:
    """Raise each cell whose middle lies under one of the ``faces`` to the height of that."""
    rows, columns = grid.shape
    for face in range(len(faces)):
        a, b, c = faces[face]
        ax, ay = (positions[a, 0] - low[0]) * scale[0], (positions[a, 1] - low[1]) * scale[1]
        bx, by = (positions[b, 0] - low[0]) * scale[0], (positions[b, 1] - low[1]) * scale[1]
        cx, cy = (positions[c, 0] - low[0]) * scale[0], (positions[c, 1] - low[1]) * scale[1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area <= 0.0:  # seen from below, or from the side
            continue
        az, bz, cz = positions[a, 2], positions[b, 2], positions[c, 2]
        first_row = max(int(np.ceil(min(ay, by, cy) - 0.5)), 0)
        last_row = min(int(np.floor(max(ay, by, cy) - 0.5)), rows - 1)
        first = max(int(np.ceil(min(ax, bx, cx) - 0.5)), 0)
        last = min(int(np.floor(max(ax, bx, cx) - 0.5)), columns - 1)
        for row in range(first_row, last_row + 1):
            y = row + 0.5
            for column in range(first, last + 1):
                x = column + 0.5
                to_a = (bx - x) * (cy - y) - (by - y) * (cx - x)
                to_b = (cx - x) * (ay - y) - (cy - y) * (ax - x)
                to_c = area - to_a - to_b
                if to_a >= 0.0 and to_b >= 0.0 and to_c >= 0.0:
                    height = (to_a * az + to_b * bz + to_c * cz) / area
                    grid[row, column] = max(grid[row, column], height)
