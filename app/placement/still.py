"""Contents after an edit: what stood stays, what is new stands beside it, what holds it grows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Floats
from app.placement.beside import beside, overlaps
from app.placement.rows import Arrangement
from app.placement.sized import Place, Sized
from app.placement.turning import Vector, turned


@dataclass(frozen=True, slots=True)
class Block:
    """New siblings that stand together: where each is within the block, and its size."""

    members: Mapping[int, Place]
    size: Place


def stays(sized: Sequence[Sized], children: Sequence[int]) -> bool:
    """Whether some of ``children`` stood here before, so that the others stand beside them."""
    return any(sized[child].is_kept for child in children)


def edge(each: Sized, x: float, y: float) -> Floats:
    """Left, near, right and far edge (4,) of an item whose solid's centre is at (x, y)."""
    taken = each.footprint
    x, y = x - taken.center[0], y - taken.center[1]
    width, depth = taken.size
    return np.array([x - width / 2, y - depth / 2, x + width / 2, y + depth / 2])


def hold(sized: Sequence[Sized], children: Sequence[int]) -> dict[int, Floats]:
    """The rectangles of those that stay, by number: what has a position, and what stood.

    What takes more room than it did, and finds it taken, stays no longer.
    """
    standing: dict[int, Floats] = {}
    changed: list[int] = []
    for child in children:
        each = sized[child]
        if not each.is_free:
            x, y, _ = each.item.position or (0.0, 0.0, 0.0)
            a, b, _ = each.middle
            standing[child] = edge(each, x + a, y + b)
        elif each.stood is not None and each.stood.alike and not each.grew:
            standing[child] = edge(each, *each.stood.offset[:2])
        elif each.stood is not None:
            changed.append(child)
    for child in changed:
        each = sized[child]
        assert each.stood is not None, "only such are changed"  # noqa: S101
        rectangle = edge(each, *each.stood.offset[:2])
        if standing and overlaps(rectangle, np.array(list(standing.values()))):
            each.stood = None
        else:
            standing[child] = rectangle
    return standing


def stand(
    standing: Mapping[int, Floats], blocks: Sequence[Block], gap: float, arrangement: Arrangement
) -> tuple[dict[int, Place], Floats]:
    """Middles of the footprints of new ones, by number, and the edges (4,) around all."""
    taken = list(standing.values())
    places: dict[int, Place] = {}
    for block in blocks:
        x, y = beside(np.array(taken), block.size, gap, arrangement)
        width, depth = block.size
        taken.append(np.array([x - width / 2, y - depth / 2, x + width / 2, y + depth / 2]))
        places.update((child, (x + a, y + b)) for child, (a, b) in block.members.items())
    all_of_them = np.array(taken)
    return places, np.concatenate([all_of_them[:, :2].min(axis=0), all_of_them[:, 2:].max(axis=0)])


def shift(sized: Sequence[Sized], parent: Sized, children: Sequence[int], by: Place) -> None:
    """Move the middle of ``parent`` within its parent, and not what stands in it."""
    if not any(by) or parent.stood is None:
        return
    x, y = by
    parent.stood = replace(
        parent.stood,
        offset=_moved(parent.stood.offset, turned(parent.turn, (x, y, 0.0))),
        center=_moved(parent.stood.center, turned(parent.stood.rotation, (x, y, 0.0))),
    )
    parent.children = {child: (a - x, b - y) for child, (a, b) in parent.children.items()}
    for child in children:
        stood = sized[child].stood
        if stood is not None:
            sized[child].stood = replace(stood, offset=_moved(stood.offset, (-x, -y, 0.0)))


def _moved(place: Vector, by: Vector) -> Vector:
    return (place[0] + by[0], place[1] + by[1], place[2] + by[2])
