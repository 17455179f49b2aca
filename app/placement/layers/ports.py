"""Where hyperedges end on items in layers: on the left and right sides, in rows."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.notations.notation import Notation
from app.placement.attaching import ends_at_points
from app.placement.fitting import resized, shape_of
from app.placement.placement import Placement
from app.program.model import Attachment, Program
from app.program.port_rows import ROW, rows_beside
from app.solids.solid import Box

NEARLY = 1e-6
EDGE = 0.3
"""Between the outermost port and the edge of an item that is made as high as its ports need."""


@dataclass(frozen=True, slots=True, eq=False)
class Ports:
    """The a attachments of a program, as ports: ``sides`` (a,) and ``rows`` (a,).

    ``firsts`` (n,): height of an item's first row over its centre; ``spans`` (n,): rows from there
    to its last. ``depths`` (n,): how far before its centre the ports of an item are. ``exact``:
    whether all ports are in rows, and at the sides of items that stand for themselves, so that
    ways can be constructed. ``named`` (a,): those at a point of the document. ``items`` (a,) are
    the attachments' own, ``positions`` (a, 3) relative to the centres of what these stand in, and
    ``directions`` (a, 3) unit vectors.
    """

    sides: Indices
    rows: Indices
    firsts: Floats
    spans: Indices
    depths: Floats
    named: Flags
    items: Indices
    positions: Floats
    directions: Floats
    exact: bool


def flows_out(program: Program) -> Flags:
    """Whether each attachment (a,) drives its hyperedge: where none says so, the first does."""
    found: list[bool] = []
    for hyperedge in program.hyperedges:
        ends = [end.flow == "out" for end in hyperedge.attachments]
        if not any(ends):
            ends[0] = True
        found.extend(ends)
    return np.array(found, dtype=np.bool_)


def with_ports(
    program: Program, notation: Notation, placed: Placement, roots: Indices
) -> tuple[Placement, Ports]:
    """Items with room for their ports, and the ports. ``roots`` (n,) are what items stand in."""
    ends = [end for hyperedge in program.hyperedges for end in hyperedge.attachments]
    positions, directions, items = ends_at_points(program, program.hyperedges, placed)
    relative = positions - placed.centers[roots[items]]
    sides = np.where(flows_out(program), 1, -1)
    named = np.array([end.point is not None for end in ends], dtype=np.bool_)
    aside = named & (np.abs(directions[:, 0]) > 1.0 - NEARLY)
    sides[aside] = np.sign(directions[aside, 0]).astype(np.int64)
    exact = bool((aside | ~named).all() and (roots[items] == items).all())
    placed = _with_room(program, notation, placed, items, sides, named)
    count = len(placed.centers)
    relative[~named] = _on_sides(placed, items, sides, ends, named)
    rows = np.zeros(len(ends), dtype=np.int64)
    firsts, depths, spans = np.zeros(count), np.zeros(count), np.zeros(count, dtype=np.int64)
    owners = roots[items]
    for item in np.unique(owners).tolist():
        here = np.flatnonzero(owners == item)
        heights = relative[here, 2]
        firsts[item], depths[item] = heights.max(), relative[here[0], 1]
        at = (firsts[item] - heights) / ROW
        rows[here] = np.rint(at).astype(np.int64)
        spans[item] = rows[here].max()
        exact &= bool(
            (np.abs(at - rows[here]) < NEARLY).all()
            and (np.abs(relative[here, 1] - depths[item]) < NEARLY).all()
            and _differ(rows[here], sides[here])
        )
    directions[~named] = 0.0
    directions[~named, 0] = sides[~named]
    return placed, Ports(
        sides, rows, firsts, spans, depths, named, items, relative, directions, exact
    )


def _differ(rows: Indices, sides: Indices) -> bool:
    """Whether no two ports are at one place."""
    return len(set(zip(rows.tolist(), sides.tolist(), strict=True))) == len(rows)


def _unnamed(
    items: Indices, sides: Indices, named: Flags
) -> dict[int, tuple[list[int], list[int]]]:
    """The attachments without a point on the left and the right of each item that has some."""
    found: dict[int, tuple[list[int], list[int]]] = defaultdict(lambda: ([], []))
    for row in np.flatnonzero(~named).tolist():
        found[int(items[row])][int(sides[row] > 0)].append(row)
    return found


def _with_room(
    program: Program, notation: Notation, placed: Placement, items: Indices, sides: Indices,
    named: Flags,
) -> Placement:  # fmt: skip
    """Items whose size nobody fixed, as high as their ports need."""
    sizes, solids = placed.sizes.copy(), list(placed.solids)
    holders = set(placed.parents.tolist())
    for item, (left, right) in _unnamed(items, sides, named).items():
        solid = solids[item]
        shape = shape_of(
            program.items[item], notation.item_style(program.items[item].kind), has_children=False
        )
        if not isinstance(solid, Box) or item in holders or getattr(shape, "size", None):
            continue
        rows = rows_beside(len(left), len(right))
        needed = ROW * max([0, *rows[0], *rows[1]]) + 2 * EDGE
        width, depth, height = solid.size
        solids[item] = resized(shape, solid, (width, depth, max(height, needed)))
        sizes[item, 2] = max(height, needed)
    return replace(placed, sizes=sizes, solids=tuple(solids))


def _on_sides(
    placed: Placement, items: Indices, sides: Indices, ends: list[Attachment],
    named: Flags,
) -> Floats:  # fmt: skip
    """Places of attachments without a point, relative to their items' centres."""
    found = np.zeros((len(ends), 3))
    for item, both in _unnamed(items, sides, named).items():
        width, _, height = placed.sizes[item].tolist()
        rows = rows_beside(len(both[0]), len(both[1]))
        last = max([0, *rows[0], *rows[1]])
        pitch = min(ROW, height / (last + 1))
        for side, members, places in zip((-1, 1), both, rows, strict=True):
            for row, place in zip(members, places, strict=True):
                found[row] = (side * width / 2, 0.0, pitch * (last / 2 - place))
    return found[~named]
