"""Labels as text: where each stands on the sheet, as an affine map of its plane."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from app.arrays import Floats
from app.output.svg_projection import Projection
from app.placement.placement import LabelPlace
from app.placement.turning import matrices
from app.solids.fonts import typefaces
from app.solids.lettering import extent

FAMILY = "Inter, 'Noto Sans', 'Fira Code', 'Helvetica Neue', Arial, sans-serif"

EDGE_ON = 0.03
"""Cosine below which a label is seen too much from the side to be written."""

STEP = 1e-3
"""Of a label's size, for measuring how the camera shows its plane."""


@dataclass(frozen=True, slots=True, eq=False)
class Writing:
    """A label: ``matrix`` maps from a plane whose unit is a pixel, y down, to the sheet.

    Its baseline begins at 0, ``size`` is that of the font and ``length`` how wide the text is, in
    that plane. ``triangles`` (2, 3, 3) are its box, for who is in front.
    """

    owner: int
    text: str
    matrix: tuple[float, ...]
    size: float
    length: float
    color: str
    triangles: Floats


def write(
    owner: int, place: LabelPlace, body: tuple[Floats, Floats], color: str, view: Projection
) -> Writing | None:
    """The label of a body turned by (3, 3) and centred at (3,); none where it cannot be read."""
    turn, center = body
    own = turn @ matrices(np.array(place.rotation))
    width, tall, depth = place.size
    middle = center + turn @ np.array(place.position) + own[:, 2] * (depth / 2)
    sight = view.sight(middle)
    if width <= 0 or tall <= 0 or own[:, 2] @ sight < EDGE_ON * np.linalg.norm(sight):
        return None
    across, up = own[:, 0] * (width / 2), own[:, 1] * (tall / 2)
    box = middle + np.array([-across - up, across - up, across + up, -across + up])
    seen = view.seen(np.concatenate([box, middle + STEP * np.array([across, -across, up, -up])]))
    scale = float(view.sizes(view.seen(middle)[2:])[0])
    x = (seen[4, :2] - seen[5, :2]) / (STEP * width * scale)
    y = (seen[7, :2] - seen[6, :2]) / (STEP * tall * scale)
    room = extent(place.text.text, place.text.height)
    # From the middle of the ink to where the pen begins, on the baseline.
    start = seen[:4, :2].mean(axis=0) - x * scale * width / 2
    start += y * scale * (room.top + room.bottom) / 2
    return Writing(
        owner,
        place.text.text,
        (*x.tolist(), *y.tolist(), *start.tolist()),
        place.text.height * scale / _capital(),
        width * scale,
        color,
        seen[np.array([(0, 1, 2), (0, 2, 3)])],
    )


@lru_cache(maxsize=1)
def _capital() -> float:
    """Height of a capital H of the first typeface, in sizes of the font."""
    face = typefaces()[0]
    return face.capital / float(face.font.face.upem)
