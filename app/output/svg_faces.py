"""Items as faces of flat colour: what of them is turned to the camera, in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats, Indices
from app.output.svg_projection import Projection
from app.output.svg_shades import Shades
from app.solids.solid import Box, Tray


@dataclass(frozen=True, slots=True, eq=False)
class Face:
    """A part of an item that nothing of itself can hide.

    ``outline`` are contours (k, 2) to be filled with ``color``, turning so that x · y' - y · x' is
    positive around what is filled; ``lines`` are drawn along them, every contour where there are
    none. ``tones`` are what lies over it in other colours. All sides of one that ``is_polygon`` are
    straight. ``triangles`` (t, 3, 3) say where it is,
    for who is in front.
    """

    owner: int
    outline: Sequence[Floats]
    color: str
    triangles: Floats
    lines: Sequence[Floats] | None = None
    tones: Sequence[tuple[str, Sequence[Floats]]] = ()
    is_polygon: bool = False


# Corners of a block: 0 to 3 around its bottom, counter-clockwise seen from above from the front
# left one on, 4 to 7 above them; of a tray 8 to 11 inside its rim, 12 to 15 around its floor.
_SIGNS = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
_QUARTERS = tuple((k, (k + 1) % 4) for k in range(4))
_WALLS = [(a, b, b + 4, a + 4) for a, b in _QUARTERS]
_BOX = np.array([*_WALLS, (4, 5, 6, 7), (3, 2, 1, 0)])
_TRAY = np.array(
    [
        *_WALLS,
        *((a + 4, b + 4, b + 8, a + 8) for a, b in _QUARTERS),
        *((b + 12, a + 12, a + 8, b + 8) for a, b in _QUARTERS),
        (12, 13, 14, 15),
        (3, 2, 1, 0),
    ]
)
_FAN = np.array([(0, 1, 2), (0, 2, 3)])


def corners_of(block: Box | Tray) -> Floats:
    """Corners of a block in its own axes: (8, 3) of a box, (16, 3) of a tray."""
    x, y, z = (size / 2 for size in block.size)
    rings = [(x, y, -z), (x, y, z)]
    if isinstance(block, Tray):
        wall = block.wall
        rings += [(x - wall, y - wall, z), (x - wall, y - wall, block.floor - z)]
    return np.concatenate(
        [np.column_stack([_SIGNS * (a, b), np.full(4, height)]) for a, b, height in rings]
    )


def block_edges(block: Box | Tray) -> Indices:
    """Pairs (e, 2) of corners between which a block has an edge."""
    levels = range(0, 16 if isinstance(block, Tray) else 8, 4)
    around = [(level + a, level + b) for level in levels for a, b in _QUARTERS]
    upright = [(k, k + 4) for k in range(4)]
    upright += [(k + 8, k + 12) for k in range(4)] if isinstance(block, Tray) else []
    return np.array(around + upright)


def block_faces(
    owners: Sequence[int],
    corners: Floats,
    shades: Sequence[Shades],
    projection: Projection,
) -> list[Face]:
    """What is to be seen of blocks alike: ``corners`` (b, 8 or 16, 3) in the world."""
    table = _BOX if corners.shape[1] == 8 else _TRAY
    places = corners[:, table]
    across = np.cross(places[:, :, 2] - places[:, :, 0], places[:, :, 3] - places[:, :, 1])
    lengths = np.linalg.norm(across, axis=-1, keepdims=True)
    normals = np.divide(across, lengths, out=np.zeros_like(across), where=lengths > 0)
    towards = np.einsum("bfi,bfi->bf", normals, projection.sight(places.mean(axis=2)))
    seen = projection.seen(corners)[:, table]
    brightness = Shades.brightness(normals)
    faces: list[Face] = []
    for block, number in zip(*np.nonzero(towards > 1e-9), strict=True):
        quad = seen[block, number]
        lines = None
        if len(table) > 6 and 4 <= number < 8:
            # The parts of a rim meet without a line.
            lines = [quad[:2, :2], quad[2:, :2]]
        faces.append(
            Face(
                owners[block],
                # Seen from outside it is counter-clockwise where y points up.
                [quad[::-1, :2]],
                shades[block].tone(float(brightness[block, number])),
                quad[_FAN],
                lines,
                is_polygon=True,
            )
        )
    return faces
