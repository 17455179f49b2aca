"""Box and tray: profiles led around a rectangle."""

from __future__ import annotations

import numpy as np

from app.solids.lathe import corner, point, rectangle, turn
from app.solids.mesh import Mesh
from app.solids.rounding import rounding
from app.solids.solid import Box, Tray


def block_mesh(block: Box | Tray, coarseness: float = 0.0) -> Mesh:
    """The mesh of a block, massive or hollow; what is round may be off by ``coarseness``."""
    return _box(block, coarseness) if isinstance(block, Box) else _tray(block, coarseness)


def _box(box: Box, coarseness: float) -> Mesh:
    """``edge`` is held below half the smallest size, so that each side stays flat."""
    x, y, z = (size / 2 for size in box.size)
    edge, segments = rounding(
        box.edge, limit=2 * min(x, y, z), reach=max(x, y, z), coarseness=coarseness
    )
    profile = np.concatenate(
        [corner(edge, -z, -1, edge, segments), corner(edge, z, 0, edge, segments)]
    )
    return turn(rectangle(x - edge, y - edge, segments), profile)


def _tray(tray: Tray, coarseness: float) -> Mesh:
    """Round corners and a soft rim."""
    x, y, z = (size / 2 for size in tray.size)
    bend, wall, floor = hollow(tray)
    floor -= z
    edge, segments = rounding(
        0.4 * wall,
        limit=min(wall, z - floor, 2 * z),
        reach=max(x, y, z),
        coarseness=coarseness,
    )
    profile = np.concatenate(
        [
            point(0.0, -z, (0.0, -1.0)),
            corner(bend, -z, -1, edge, segments),
            corner(bend, z, 0, edge, segments),
            corner(bend - wall, z, 1, edge, segments),
            point(bend - wall, floor, (-1.0, 0.0)),
            point(bend - wall, floor, (0.0, 1.0)),
            point(0.0, floor, (0.0, 1.0)),
        ]
    )
    return turn(rectangle(x - bend, y - bend, segments and segments + 1), profile)


def hollow(tray: Tray) -> tuple[float, float, float]:
    """Radius of a tray's corners outside, thickness of its walls and of its floor.

    Walls are held below half the smaller side and the floor below the height: however thick they
    are to be, a hollow remains.
    """
    x, y, z = (size / 2 for size in tray.size)
    # One and a half walls outside leave half a wall inside: both corners look rounded.
    bend = min(1.5 * tray.wall, 0.98 * min(x, y))
    return bend, min(tray.wall, 0.8 * bend), min(tray.floor, 0.9 * 2 * z)
