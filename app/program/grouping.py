"""Items move into a new one around them, and out again. Those with positions stay in place."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.program.base import Vector
from app.program.editable import Editable
from app.program.model import Item


def group(program: Editable, names: Sequence[str], tray: Item) -> None:
    """Move items of one parent into ``tray``, a new item of that parent.

    Where all have positions, the tray's, if it has none, is the middle between them; and they
    become relative to it. Otherwise a new place is found for all of them.
    """
    items = [program.items[name] for name in names]
    places = [item.position for item in items if item.position is not None]
    if len(places) < len(items):
        positions: list[Vector | None] = [None] * len(items)
    else:
        corners = np.array(places)
        if tray.position is None:
            middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
            tray = tray.model_copy(update={"position": _vector(middle)})
        positions = [_vector(corner - np.array(tray.position)) for corner in corners]
    program.put_item(tray)
    for item, position in zip(items, positions, strict=True):
        program.leave_line_ups(item.id)
        program.put_item(item.model_copy(update={"parent": tray.id, "position": position}))


def ungroup(program: Editable, name: str) -> None:
    """Move what an item contains out of it, and remove the item."""
    tray = program.items[name]
    for content in program.contents(name):
        item = program.items[content]
        position = None
        if item.position is not None and tray.position is not None and tray.rotation is None:
            position = _vector(np.array(item.position) + np.array(tray.position))
        program.leave_line_ups(content)
        program.put_item(item.model_copy(update={"parent": tray.parent, "position": position}))
    program.remove_items([name])


def _vector(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Vector:
    x, y, z = (float(np.clip(value, -1e6, 1e6)) for value in values)
    return x, y, z
