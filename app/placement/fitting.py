"""Solids with every size known: what the document leaves out is fitted to label and contents."""

from __future__ import annotations

from typing import assert_never

from app.notations.notation import ItemStyle
from app.placement.trees import tree_of
from app.program import shapes
from app.program.model import Item
from app.solids.csg_bodies import body_of
from app.solids.lettering import TextExtent, extent
from app.solids.solid import Arrow, Box, Cone, Csg, Cylinder, Size, Solid, Sphere, Text, Tray

EDGE = 0.05
"""Rounding of edges: enough for light to catch, little enough to look crisp."""

WALL = 0.07
FLOOR = 0.06
RIM = 0.09
"""How far a tray's walls rise above its floor: what stands behind a wall stays visible."""

LABEL_DEPTH = 0.07
"""Thickness of letters; they are sunk by half of it."""

LABEL_MARGIN = 0.14
"""Between letters and the edge of their face."""

BLANK: Size = (0.7, 0.6, 0.5)
"""A block without a label."""


def shape_of(item: Item, style: ItemStyle, has_children: bool) -> shapes.Shape:
    """The shape that the document or the notation wishes, with what neither says left out."""
    if item.shape is None:
        if style.shape is not None:
            return style.shape
        return shapes.Tray(type="tray") if has_children else shapes.Box(type="box")
    if style.shape is not None and type(style.shape) is type(item.shape):
        said = item.shape.model_dump(exclude_none=True)
        return style.shape.model_copy(update={**said, **_sizes(item.shape)})
    return item.shape


def _sizes(shape: shapes.Shape) -> dict[str, object]:
    return {name: value for name, value in shape if value is not None}


def written_extent(label: str, height: float) -> TextExtent | None:
    """How much room ``label`` takes, or ``None`` where there is nothing to write."""
    room = extent(label, height)
    return room if room.width > 0 else None


def fit(
    shape: shapes.Shape,
    item: Item,
    style: ItemStyle,
    label: TextExtent | None,
    contents: tuple[float, float],
) -> Solid:
    """The solid for ``shape``: around ``contents`` (width, depth, with margins) and its label.

    Raises what `app.solids.csg.make_body` does.
    """
    match shape:
        case shapes.Box(size=size):
            return _box(size or _block(style, label, contents))
        case shapes.Tray(size=size, wall=wall):
            if size is None:
                room = 2 * (wall or WALL)
                size = (contents[0] + room, contents[1] + room, FLOOR + RIM)
            return _tray(size, wall)
        case shapes.Sphere(radius=radius):
            return Sphere(radius or 0.35)
        case shapes.Cylinder(radius=radius, height=height):
            radius, height = radius or 0.35, height or 0.6
            return Cylinder(radius, height, min(EDGE, 0.2 * min(radius, height)))
        case shapes.Cone(radius=radius, height=height):
            return Cone(radius or 0.4, height or 0.8)
        case shapes.Arrow(length=length, radius=radius):
            return Arrow(length or 1.2, radius or 0.2)
        case shapes.Csg(tree=root):
            tree = tree_of(root)
            body = body_of(tree)
            return Csg(tree, body.size, body.middle, body.top)
        case shapes.Text(height=height, depth=depth):
            return Text(item.label or "", height or 1.5 * style.label_height, depth or 0.15)
        case _:
            assert_never(shape)


def resized(shape: shapes.Shape, solid: Solid, size: Size) -> Solid:
    """The block or the tray for ``shape`` with another ``size``; other solids as they are."""
    match solid, shape:
        case Box(), _:
            return _box(size)
        case Tray(), shapes.Tray(wall=wall):
            return _tray(size, wall)
        case _:
            return solid


def _box(size: Size) -> Box:
    return Box(size, min(EDGE, 0.2 * min(size)))


def _tray(size: Size, wall: float | None) -> Tray:
    return Tray(size, min(wall or WALL, 0.4 * min(size[:2])), min(FLOOR, 0.5 * size[2]))


def _block(style: ItemStyle, label: TextExtent | None, contents: tuple[float, float]) -> Size:
    width, depth, height = BLANK
    if label is not None:
        width = max(width, label.width + 2 * LABEL_MARGIN)
        height = max(1.8 * style.label_height, label.top - label.bottom + 1.2 * LABEL_MARGIN)
    return (max(width, contents[0]), max(depth, contents[1]), height)
