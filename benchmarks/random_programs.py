"""Random programs whose hyperedges can be kept apart: what routing is measured and tested with.

Items are blocks of differing heights, scattered over a plane without overlap. Hyperedges join two
to five of them, each at a place of its own on the item's top. Any two such places of different
hyperedges are at least twice the sum of their radii and the clearance apart, and a place is as far
from the items of others: so there is room to pass between them, and a clear layout exists.

In a *spread* program a hyperedge joins items from anywhere; in a *local* one the items nearest to
a random one, so that many hyperedges are far from most others, as in large programs of people.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from app.arrays import Floats, Indices
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings

Reach = Literal["spread", "local"]

CLEARANCE = 0.05
THINNEST, THICKEST = 0.1, 0.2
FEWEST, MOST = 2, 5
ITEMS = {10: 20, 30: 50, 100: 100}
"""Items for so many hyperedges; for other numbers, as many as hyperedges."""

NEIGHBOURS = 12
"""Among so many items nearest to its first one a local hyperedge chooses the others."""

LOOSENESS = 1.25
"""How much wider the cells of places on an item are than the places must be apart."""

INSET = THICKEST + CLEARANCE
"""Of places from the rim of their item: the whole end of a tube stands on it."""

GAP = 2 * (2 * THICKEST + CLEARANCE) - INSET
"""Between items: so far that a place is also far enough from every other item."""

FILL = 0.45
"""Share of the plane that items take with their gaps, at first; crowds are pushed apart."""

PUSHES = 60
"""Rounds of pushing before the plane is made wider."""

WIDER = 1.05
LOWEST, HIGHEST = 0.3, 0.9


@dataclass(frozen=True, slots=True, eq=False)
class RandomProgram:
    """n items, and h hyperedges with a attachments in all; document units, z up.

    ``centers`` (n, 3), ``sizes`` (n, 3); ``positions`` (a, 3) of attachments in the world,
    ``items`` (a,) the numbers of the items that they are on; those of hyperedge k are ``starts[k]``
    to ``starts[k + 1]`` (h + 1,). ``radii`` (h,).
    """

    centers: Floats
    sizes: Floats
    positions: Floats
    items: Indices
    starts: Indices
    radii: Floats

    def document(self, **layout: Any) -> dict[str, Any]:
        """The program as a document, with ``layout`` in the section of that name."""
        relative = self.positions - self.centers[self.items]
        order = np.argsort(self.items, kind="stable")
        bounds = np.searchsorted(self.items[order], np.arange(len(self.centers) + 1)).tolist()
        points = [
            {"id": f"p{number}", "position": at}
            for number, at in zip(order.tolist(), relative[order].tolist(), strict=True)
        ]
        items = [
            {
                "id": f"i{number}",
                "shape": {"type": "box", "size": size},
                "position": center,
                "attachment_points": points[bounds[number] : bounds[number + 1]],
            }
            for number, (center, size) in enumerate(
                zip(self.centers.tolist(), self.sizes.tolist(), strict=True)
            )
        ]
        ends = [
            {"item": f"i{item}", "point": f"p{number}"}
            for number, item in enumerate(self.items.tolist())
        ]
        starts = self.starts.tolist()
        hyperedges = [
            {
                "id": f"e{k}",
                "attachments": ends[starts[k] : starts[k + 1]],
                "radius": radius,
            }
            for k, radius in enumerate(self.radii.tolist())
        ]
        return {
            "items": items,
            "hyperedges": hyperedges,
            "layout": {"clearance": CLEARANCE, **layout},
        }

    def program(self) -> Program:
        """The document, read as the service reads it."""
        return read_program(json.dumps(self.document()).encode(), Settings())

    def placement(self) -> Placement:
        """The document, read and placed as the service does it."""
        program = self.program()
        return place(program, load_notation(program.notation))


def random_program(hyperedges: int, seed: int, reach: Reach = "spread") -> RandomProgram:
    """The program number ``seed`` of so many hyperedges: the same wherever it is made."""
    chance = np.random.default_rng([hyperedges, seed, reach == "local"])
    count = ITEMS.get(hyperedges, max(hyperedges, MOST))
    radii = chance.uniform(THINNEST, THICKEST, hyperedges)
    arities = chance.integers(FEWEST, MOST, hyperedges, endpoint=True)
    plane = chance.random((count, 2))
    joined = _anywhere(chance, hyperedges, count)
    if reach == "local":
        joined = _nearby(chance, plane, joined[:, 0])
    starts = np.concatenate([[0], np.cumsum(arities)])
    items = joined[np.arange(MOST) < arities[:, None]]
    offsets, tops = _places(chance, items, np.repeat(radii, arities), count)
    sizes = np.column_stack([tops, chance.uniform(LOWEST, HIGHEST, count)])
    side = np.sqrt(float(np.prod(tops + GAP, axis=1).sum()) / FILL)
    middles = _apart(plane * side, tops + GAP)
    centers = np.column_stack([middles, sizes[:, 2] / 2])
    positions = np.column_stack([middles[items] + offsets, sizes[items, 2]])
    return RandomProgram(centers, sizes, positions, items, starts, radii)


def _anywhere(chance: np.random.Generator, hyperedges: int, count: int) -> Indices:
    """Different items (h, 5) for each hyperedge."""
    chosen = chance.integers(0, count, (hyperedges, MOST))
    while True:
        ordered = np.sort(chosen, axis=1)
        again = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
        if not again.any():
            return chosen
        chosen[again] = chance.integers(0, count, (int(again.sum()), MOST))


def _nearby(chance: np.random.Generator, plane: Floats, firsts: Indices) -> Indices:
    """Different items (h, 5) for each hyperedge: its first, and some of those nearest to it."""
    most = min(NEIGHBOURS, len(plane) - 1)
    _, nearest = cKDTree(plane).query(plane[firsts], k=most + 1)
    order = np.argsort(chance.random((len(firsts), most)), axis=1)[:, : MOST - 1]
    others = np.take_along_axis(nearest[:, 1:], order, axis=1)
    return np.column_stack([firsts, others])


def _places(
    chance: np.random.Generator, items: Indices, radii: Floats, count: int
) -> tuple[Floats, Floats]:
    """Places (a, 2) about the middles of their items, and the items' widths and depths (n, 2).

    On a square grid of cells, each a little beside its cell's middle. ``radii`` (a,).
    """
    order = np.lexsort((-radii, items))
    degrees = np.bincount(items, minlength=count)
    firsts = np.cumsum(degrees) - degrees
    ranks = np.empty(len(items), dtype=np.int64)
    ranks[order] = np.arange(len(items)) - firsts[items[order]]
    thickest = np.full((count, 2), THINNEST)
    for rank in range(2):
        thick = ranks == rank
        thickest[items[thick], rank] = radii[thick]
    apart = 2 * (thickest.sum(axis=1) + CLEARANCE)
    columns = np.maximum(np.ceil(np.sqrt(degrees)), 1).astype(np.int64)
    rows = np.maximum(-(-degrees // columns), 1)
    cells = LOOSENESS * apart
    grid = np.column_stack([columns, rows])
    # Which attachment gets which cell must not follow from its radius.
    shuffled = np.lexsort((chance.random(len(items)), items))
    ranks[shuffled] = np.arange(len(items)) - firsts[items[shuffled]]
    cell = np.column_stack([ranks % columns[items], ranks // columns[items]])
    loose = (cells - apart)[items, None] * chance.uniform(-0.5, 0.5, cell.shape)
    offsets = (cell - (grid[items] - 1) / 2) * cells[items, None] + loose
    return offsets, (grid - 1) * cells[:, None] + (cells - apart)[:, None] + 2 * INSET


def _apart(middles: Floats, rooms: Floats) -> Floats:
    """``middles`` (n, 2) moved until their rectangles ``rooms`` (n, 2) do not overlap."""
    reach = float(np.hypot(*rooms.max(axis=0)))
    while True:
        for _ in range(PUSHES):
            pairs = cKDTree(middles).query_pairs(reach, output_type="ndarray")
            pushes = _pushes(middles, rooms, pairs)
            if pushes is None:
                return middles
            middles = middles + pushes
        middles = middles * WIDER


def _pushes(middles: Floats, rooms: Floats, pairs: NDArray[np.intp]) -> Floats | None:
    """How far each is pushed along x or y, (n, 2); ``None`` where no two overlap."""
    one, other = pairs.T
    way = middles[other] - middles[one]
    deep = (rooms[one] + rooms[other]) / 2 - np.abs(way)
    overlap = deep.min(axis=1) > 0
    if not overlap.any():
        return None
    one, other, way, deep = one[overlap], other[overlap], way[overlap], deep[overlap]
    axis = (deep[:, 1] < deep[:, 0]).astype(np.int64)
    row = np.arange(len(axis))
    # A little more than half the depth each, so that rounding leaves no overlap.
    push = 0.51 * deep[row, axis] * np.where(way[row, axis] >= 0, 1.0, -1.0)
    pushes = np.zeros_like(middles)
    np.add.at(pushes, (one, axis), -push)
    np.add.at(pushes, (other, axis), push)
    return pushes
