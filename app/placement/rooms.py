"""How far items can grow after an edit without reaching their neighbours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from app.arrays import Floats
from app.placement.family import Family
from app.placement.labels import caption
from app.placement.sized import Sized
from app.placement.turning import UNTURNED
from app.solids.solid import Tray

ENDLESS: Floats = np.array([-np.inf, -np.inf, np.inf, np.inf])
"""Left, near, right and far edge of everything."""

TOUCHING = 1e-9
"""What rounding leaves between rectangles that touch."""


def edge(each: Sized, x: float, y: float) -> Floats:
    """Left, near, right and far edge (4,) of an item whose solid's centre is at (x, y)."""
    taken = each.footprint
    x, y = x - taken.center[0], y - taken.center[1]
    width, depth = taken.size
    return np.array([x - width / 2, y - depth / 2, x + width / 2, y + depth / 2])


def edge_of_fixed(each: Sized) -> Floats:
    """The edges (4,) of an item that has a position."""
    x, y, _ = each.item.position or (0.0, 0.0, 0.0)
    a, b, _ = each.middle
    return edge(each, x + a, y + b)


def stood_edge(each: Sized) -> Floats | None:
    """The edges (4,) of an item that has a position, or stood somewhere before."""
    if not each.is_free:
        return edge_of_fixed(each)
    return None if each.stood is None else edge(each, *each.stood.offset[:2])


class Rooms:
    """Room around the items of a program, whose parents and ``gaps`` between siblings are known.

    ``gaps`` are one for the contents of each item, and a last one for the roots.
    """

    def __init__(self, sized: Sequence[Sized], family: Family, gaps: Sequence[float]) -> None:
        self._sized, self._family, self._gaps = sized, family, gaps
        self._edges: dict[int, tuple[dict[int, int], Floats]] = {}
        self._known: dict[int, Floats] = {}

    def within(self, number: int) -> Floats:
        """The edges (4,) that contents of an item may reach, from its origin; -1: of the world."""
        if number < 0 or self._sized[number].stood is None:
            return ENDLESS
        each = self._sized[number]
        left, near, right, far = self._around(number)
        aside, before = caption(each.solid, each.label, each.style.caption)
        padding = each.style.padding
        wide, deep = _inner(each)
        return np.array(
            [
                -wide - left + padding + aside,
                -deep - near + padding + before,
                wide + right - padding,
                deep + far - padding,
            ]
        )

    def _around(self, number: int) -> Floats:
        """How far (4,) an item can grow to its left, near, right and far side."""
        if number not in self._known:
            self._known[number] = self._found(number)
        return self._known[number]

    def _found(self, number: int) -> Floats:
        each = self._sized[number]
        if not each.can_grow:
            return np.zeros(4)
        if each.turn != UNTURNED:
            return np.full(4, np.inf)
        parent = self._family.parents[number]
        places, edges = self._siblings(parent)
        if number not in places:
            return np.full(4, np.inf)
        own = edges[places[number]]
        others = np.delete(edges, places[number], axis=0)
        free = _free(own, others, self._gaps[parent])
        if parent >= 0:
            free = np.minimum(free, self._to_edges(parent, own))
        if not each.is_free:
            # Its centre cannot move.
            free[:2] = free[2:] = np.minimum(free[:2], free[2:])
        return np.maximum(free, 0.0)

    def _to_edges(self, parent: int, own: Floats) -> Floats:
        reach = self.within(parent)
        return np.concatenate([own[:2] - reach[:2], reach[2:] - own[2:]])

    def _siblings(self, parent: int) -> tuple[dict[int, int], Floats]:
        """Rows of those that stand, by number, in their edges (k, 4)."""
        if parent not in self._edges:
            children = self._family.roots if parent < 0 else self._family.children[parent]
            found = {
                child: rectangle
                for child in children
                if (rectangle := stood_edge(self._sized[child])) is not None
            }
            rows = {child: row for row, child in enumerate(found)}
            self._edges[parent] = rows, np.array(list(found.values())).reshape(-1, 4)
        return self._edges[parent]


def _free(own: Floats, others: Floats, gap: float) -> Floats:
    """How far (4,) ``own`` is from the first of ``others`` (k, 4) on each side, less a gap."""
    found = np.full(4, np.inf)
    for axis in (0, 1):
        across = 1 - axis
        beside = others[
            (others[:, across] < own[across + 2] + gap - TOUCHING)
            & (others[:, across + 2] > own[across] - gap + TOUCHING)
        ]
        below = own[axis] - beside[:, axis + 2]
        above = beside[:, axis] - own[axis + 2]
        found[axis] = np.min(below[below > -TOUCHING], initial=np.inf) - gap
        found[axis + 2] = np.min(above[above > -TOUCHING], initial=np.inf) - gap
    return found


def _inner(each: Sized) -> tuple[float, float]:
    """Half the width and depth within an item's walls."""
    wall = each.solid.wall if isinstance(each.solid, Tray) else 0.0
    return each.size[0] / 2 - wall, each.size[1] / 2 - wall
