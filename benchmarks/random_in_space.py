"""Random programs whose items float, with attachments on all sides: for routing in space.

Balls and cubes are scattered over a cube of space, some distance apart. Hyperedges join two to five
of them, each at a place of its own, anywhere on the item's surface; tubes leave squarely. Any two
places are at least twice the sum of the largest radii and the clearance apart.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from app.arrays import Floats, Indices
from app.notations.loader import load_notation
from app.placement.place import place
from app.placement.placement import Placement
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings
from benchmarks.random_programs import (
    CLEARANCE,
    FEWEST,
    ITEMS,
    MOST,
    NEIGHBOURS,
    THICKEST,
    THINNEST,
    Reach,
)

APART = 2 * (2 * THICKEST + CLEARANCE)
"""Between places of attachments."""

GAP = 2.0
"""Between the balls around items."""

SMALLEST = 0.5
"""Least radius of a ball, and least half of a cube's side."""

FILL = 0.12
"""Share of space that items take with their gaps, at first."""

TRIES = 200
"""Random places for an item before space is made wider."""


@dataclass(frozen=True, slots=True, eq=False)
class RandomSpace:
    """n items, and h hyperedges with a attachments in all; document units.

    ``centers`` (n, 3), ``radii_of_items`` (n,): of balls, or half the sides of those that
    ``are_cubes`` (n,); ``positions`` and outward ``directions`` (a, 3) of attachments, relative to
    their items' centres; ``items`` (a,) are these; those of hyperedge k are ``starts[k]`` to
    ``starts[k + 1]`` (h + 1,). ``radii`` (h,).
    """

    centers: Floats
    radii_of_items: Floats
    are_cubes: np.ndarray[Any, np.dtype[np.bool_]]
    positions: Floats
    directions: Floats
    items: Indices
    starts: Indices
    radii: Floats

    def document(self, **layout: Any) -> dict[str, Any]:
        """The program as a document, with ``layout`` in the section of that name."""
        items: list[dict[str, Any]] = []
        for number, (center, radius, is_cube) in enumerate(
            zip(
                self.centers.tolist(),
                self.radii_of_items.tolist(),
                self.are_cubes.tolist(),
                strict=True,
            )
        ):
            box = {"type": "box", "size": [2 * radius] * 3}
            items.append(
                {
                    "id": f"i{number}",
                    "shape": box if is_cube else {"type": "sphere", "radius": radius},
                    "position": center,
                    "attachment_points": [],
                }
            )
        for number, item in enumerate(self.items.tolist()):
            items[item]["attachment_points"].append(
                {
                    "id": f"p{number}",
                    "position": self.positions[number].tolist(),
                    "direction": self.directions[number].tolist(),
                }
            )
        ends = [
            {"item": f"i{item}", "point": f"p{number}"}
            for number, item in enumerate(self.items.tolist())
        ]
        starts = self.starts.tolist()
        hyperedges = [
            {"id": f"e{k}", "attachments": ends[starts[k] : starts[k + 1]], "radius": radius}
            for k, radius in enumerate(self.radii.tolist())
        ]
        return {
            "items": items,
            "hyperedges": hyperedges,
            "layout": {"clearance": CLEARANCE, **layout},
            "style": {"ground": False},
        }

    def program(self) -> Program:
        """The document, read as the service reads it."""
        return read_program(json.dumps(self.document()).encode(), Settings())

    def placement(self) -> Placement:
        """The document, read and placed as the service does it."""
        program = self.program()
        return place(program, load_notation(program.notation))


def random_in_space(hyperedges: int, seed: int, reach: Reach = "spread") -> RandomSpace:
    """The program number ``seed`` of so many hyperedges: the same wherever it is made."""
    chance = np.random.default_rng([hyperedges, seed, reach == "local", 3])
    count = ITEMS.get(hyperedges, max(hyperedges, MOST))
    radii = chance.uniform(THINNEST, THICKEST, hyperedges)
    arities = chance.integers(FEWEST, MOST, hyperedges, endpoint=True)
    space = chance.random((count, 3))
    joined = np.array([chance.permutation(count)[:MOST] for _ in range(hyperedges)])
    if reach == "local":
        most = min(NEIGHBOURS, count - 1)
        _, nearest = cKDTree(space).query(space[joined[:, 0]], k=most + 1)
        order = np.argsort(chance.random((hyperedges, most)), axis=1)[:, : MOST - 1]
        others = np.take_along_axis(nearest[:, 1:], order, axis=1)
        joined = np.column_stack([joined[:, 0], others])
    items = joined[np.arange(MOST) < arities[:, None]].astype(np.int64)
    starts = np.concatenate([[0], np.cumsum(arities)])
    are_cubes = chance.random(count) < 0.5
    positions, directions = np.empty((len(items), 3)), np.empty((len(items), 3))
    sizes = np.empty(count)
    for item in range(count):
        rows = np.flatnonzero(items == item)
        places = _on_cube if are_cubes[item] else _on_ball
        sizes[item], there, outward = places(len(rows))
        chosen = chance.permutation(len(there))[: len(rows)]
        positions[rows], directions[rows] = there[chosen], outward[chosen]
    rooms = sizes * np.where(are_cubes, np.sqrt(3.0), 1.0) + GAP / 2
    centers = _apart(chance, space, rooms)
    return RandomSpace(centers, sizes, are_cubes, positions, directions, items, starts, radii)


def _on_ball(count: int) -> tuple[float, Floats, Floats]:
    """A radius, and at least so many places on the ball, `APART`, with their directions."""
    count = max(count, 6)
    heights = 1.0 - 2.0 * (np.arange(count) + 0.5) / count
    turns = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    rims = np.sqrt(1.0 - heights**2)
    unit = np.stack([rims * np.cos(turns), rims * np.sin(turns), heights], axis=1)
    nearest = float(cKDTree(unit).query(unit, k=2)[0][:, 1].min())
    radius = max(SMALLEST, 1.01 * APART / nearest)
    return radius, radius * unit, unit


def _on_cube(count: int) -> tuple[float, Floats, Floats]:
    """Half a side, and at least so many places on the cube, `APART`, with their directions."""
    grid = max(int(np.ceil(np.sqrt(count / 6.0))), 1)
    half = max(SMALLEST, 1.01 * (0.5 * (grid - 1) + np.sqrt(0.5)) * APART)
    steps = (np.arange(grid) - 0.5 * (grid - 1)) * 1.01 * APART
    one, other = (axis.ravel() for axis in np.meshgrid(steps, steps))
    places, directions = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            place = np.empty((len(one), 3))
            place[:, axis] = sign * half
            place[:, (axis + 1) % 3], place[:, (axis + 2) % 3] = one, other
            outward = np.zeros((len(one), 3))
            outward[:, axis] = sign
            places.append(place)
            directions.append(outward)
    return half, np.concatenate(places), np.concatenate(directions)


def _apart(chance: np.random.Generator, wished: Floats, rooms: Floats) -> Floats:
    """Places (n, 3) near the ``wished`` ones (n, 3), of a cube, for balls ``rooms`` (n,)."""
    side = float(((4.0 / 3.0 * np.pi * rooms**3).sum() / FILL) ** (1.0 / 3.0))
    found = wished * side
    for item in range(len(found)):
        reach = 0.0
        while True:
            for _ in range(TRIES):
                place = wished[item] * side + reach * chance.uniform(-1.0, 1.0, 3)
                far = np.linalg.norm(found[:item] - place, axis=1)
                if (far >= rooms[:item] + rooms[item]).all():
                    break
            else:
                reach += 1.0
                continue
            found[item] = place
            break
    return found
