"""Where labels go: on the front of blocks, along the front edge of trays, before other solids."""

from __future__ import annotations

from typing import Literal

from app.placement.fitting import LABEL_DEPTH
from app.placement.placement import LabelPlace
from app.placement.turning import UNTURNED, UPRIGHT
from app.solids.lettering import TextExtent
from app.solids.solid import Box, Size, Solid, Text, Tray

BEFORE = 0.06
"""Between a round solid and the label that stands before it."""


CAPTION_GAP = 0.1
"""Between a tray's contents and the label before them."""

SIDE_CAPTION_GAP = 0.16
"""Between a tray's contents and the label to their left: seen from the usual view, a little to the
right, a block hides a fifth of its height of what lies on its left, some 0.12."""


def caption(
    solid: Solid, label: TextExtent | None, side: Literal["front", "left"]
) -> tuple[float, float]:
    """Room that a tray's label takes: to the left of its contents, and before them."""
    if not isinstance(solid, Tray) or label is None:
        return 0.0, 0.0
    if side == "left":
        return label.width + SIDE_CAPTION_GAP, 0.0
    return 0.0, strip(label) + CAPTION_GAP


def strip(label: TextExtent | None) -> float:
    """Depth of the strip of a tray's floor that its label lies on."""
    return 0.0 if label is None else label.top - label.bottom


def front(solid: Solid, label: TextExtent | None) -> float:
    """How far a label reaches out before its solid: none does from a block or a tray."""
    if label is None or isinstance(solid, Box | Tray | Text):
        return 0.0
    return BEFORE + LABEL_DEPTH


def label_place(
    text: str, height: float, label: TextExtent, solid: Solid, size: Size, margin: float, side: bool
) -> LabelPlace:
    """The place of a label on ``solid`` of ``size``; ``margin`` is a tray's padding.

    ``side`` puts a tray's label to the left of its contents instead of before them.
    """
    letters = Text(text, height, LABEL_DEPTH)
    tall = label.top - label.bottom
    ink = (label.width, tall, LABEL_DEPTH)
    width, depth, rise = size
    match solid:
        case Tray(wall=wall, floor=floor):
            x = -width / 2 + wall + margin + label.width / 2
            y = 0.0 if side else -depth / 2 + wall + margin + tall / 2
            return LabelPlace(letters, (x, y, -rise / 2 + floor), UNTURNED, ink)
        case Box():
            # Letters without descenders sit as high as those with.
            return LabelPlace(letters, (0.0, -depth / 2, 0.0), UPRIGHT, ink)
        case _:
            y = -depth / 2 - BEFORE - LABEL_DEPTH / 2
            return LabelPlace(letters, (0.0, y, -rise / 2 + tall / 2), UPRIGHT, ink)
