"""Items around what they contain: as they need at first, and grown after an edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats
from app.placement.fitting import fit, shape_of
from app.placement.labels import caption, strip
from app.placement.rooms import TOUCHING
from app.placement.sized import Place, Sized
from app.placement.turning import moved, turned
from app.solids.extents import size_of
from app.solids.solid import Tray


@dataclass(frozen=True, slots=True)
class Contents:
    """Children arranged about a point: places of the free ones, and the box around all.

    ``fixed`` tells whether some have positions, so that nothing may be shifted. There is no box
    where all is as it was before an edit.
    """

    places: dict[int, Place]
    around: Floats | None
    fixed: bool


def enclose(parent: Sized, contents: Contents) -> None:
    """Give ``parent`` its size around ``contents``, and its free children their places."""
    beside, before = caption(parent.solid, parent.label, parent.style.caption)
    assert contents.around is not None, "only what stands has no box"  # noqa: S101
    left, near, right, far = contents.around.tolist()
    if contents.fixed:
        # Positions are relative to the parent's centre, which therefore cannot move.
        width = 2 * max(right, beside - left)
        depth = 2 * max(far, before - near)
        parent.children = contents.places
    else:
        width, depth = right - left + beside, far - near + before
        parent.children = {
            child: (x + beside / 2, y + before / 2) for child, (x, y) in contents.places.items()
        }
    margin = 2 * parent.style.padding
    size = parent.size
    _fit(parent, width + margin, depth + margin)
    parent.grew = parent.stood is not None and parent.size != size


def grow(sized: Sequence[Sized], number: int, children: Sequence[int], contents: Contents) -> None:
    """Let a parent reach around ``contents`` too, and move nothing that stands in it."""
    parent = sized[number]
    parent.children = contents.places
    if contents.around is None or (parent.is_alike and not parent.can_grow):
        return
    inner = _inner(parent)
    edges = _needed(parent, contents.around, inner if parent.is_alike else None)
    if contents.fixed or not parent.is_kept:
        # Its centre cannot move.
        reach = np.maximum(edges[2:], -edges[:2])
        edges = np.concatenate([-reach, reach])
    left, near, right, far = edges.tolist()
    if parent.is_alike and (np.abs(edges) <= np.abs(inner) + TOUCHING).all():
        return
    size = parent.size
    _fit(parent, right - left, far - near)
    if parent.can_grow:
        _shift(sized, parent, children, ((left + right) / 2, (near + far) / 2))
    parent.grew = parent.size != size


def _needed(parent: Sized, around: Floats, inner: Floats | None) -> Floats:
    """The edges (4,) within the walls that contents and label need, and those that there are."""
    beside, before = caption(parent.solid, parent.label, parent.style.caption)
    padding = parent.style.padding
    edges = around + np.array([-beside - padding, -before - padding, padding, padding])
    if inner is not None:
        edges = np.concatenate([np.minimum(edges[:2], inner[:2]), np.maximum(edges[2:], inner[2:])])
    edges[2:] = np.maximum(edges[2:], edges[:2] + _caption_size(parent))
    return np.asarray(edges)


def _inner(parent: Sized) -> Floats:
    """The edges (4,) within the walls, from the centre."""
    wall = parent.solid.wall if isinstance(parent.solid, Tray) else 0.0
    half = np.array(parent.size[:2]) / 2 - wall
    return np.concatenate([-half, half])


def _caption_size(parent: Sized) -> Place:
    """Width and depth within the walls that a tray's label needs at least."""
    if not isinstance(parent.solid, Tray) or parent.label is None:
        return 0.0, 0.0
    margin = 2 * parent.style.padding
    if parent.style.caption == "left":
        return 0.0, strip(parent.label) + margin
    return parent.label.width + margin, 0.0


def _fit(parent: Sized, width: float, depth: float) -> None:
    """Give ``parent`` its size: so much within its walls, and its label's."""
    least = _caption_size(parent)
    room = max(width, least[0]), max(depth, least[1])
    shape = shape_of(parent.item, parent.style, has_children=True)
    parent.solid = fit(shape, parent.item, parent.style, parent.label, room)
    parent.size = size_of(parent.solid)


def _shift(sized: Sequence[Sized], parent: Sized, children: Sequence[int], by: Place) -> None:
    """Move the middle of ``parent`` within its parent, and not what stands in it."""
    if not any(by) or parent.stood is None:
        return
    x, y = by
    offset = moved(parent.stood.offset, turned(parent.turn, (x, y, 0.0)))
    center = parent.stood.center
    if center is not None:
        center = moved(center, turned(parent.stood.rotation, (x, y, 0.0)))
    parent.stood = replace(parent.stood, offset=offset, center=center)
    parent.children = {child: (a - x, b - y) for child, (a, b) in parent.children.items()}
    for child in children:
        stood = sized[child].stood
        if stood is not None:
            sized[child].stood = replace(stood, offset=moved(stood.offset, (-x, -y, 0.0)))
