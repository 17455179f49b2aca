"""Siblings placed by what hyperedges join: on the ground, on an upright sheet or in space."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.arrays import Floats
from app.grouped import starts_of
from app.placement.labels import front
from app.placement.modes import Mode
from app.placement.sized import Sized
from app.placement.still import Block
from app.placement.stress.arrange import Hypergraph, arranged
from app.placement.stress.boxes import Boxes
from app.placement.stress.pairs import Progress
from app.placement.turning import Vector, moved, reach, turned

AXES: Mapping[Mode, tuple[int, ...]] = {"ground": (0, 1), "sheet": (0, 2), "space": (0, 1, 2)}
"""The axes of the world along which items are placed in each mode."""


@dataclass(frozen=True, slots=True)
class Group:
    """Siblings that are placed as one: solids' centres by number, and boxes around them.

    Each of the ``boxes`` is a low and a high corner, and whether it is a body or a label. All are
    relative to the group's origin, along the axes of the parent.
    """

    members: Mapping[int, Vector]
    boxes: Sequence[tuple[Vector, Vector, bool]]


@dataclass(frozen=True, slots=True)
class Stood:
    """Where groups are that have a place: origins by number of the group.

    Those that are ``held`` do not move; others do where they are in the way.
    """

    places: Mapping[int, Vector]
    held: frozenset[int]


NOTHING = Stood({}, frozenset())


def alone(each: Sized, number: int) -> Group:
    """A single item, with its label."""
    wide = reach(each.turn, each.size)
    low: Vector = (-wide[0] / 2, -wide[1] / 2, -wide[2] / 2)
    boxes = [(low, (wide[0] / 2, wide[1] / 2, wide[2] / 2), True)]
    label = each.label
    if label is not None and front(each.solid, label):
        # As `label_place` puts it.
        depth = front(each.solid, label)
        tall = label.top - label.bottom
        middle = (0.0, -(each.size[1] + depth) / 2, (tall - each.size[2]) / 2)
        x, y, z = turned(each.turn, middle)
        a, b, c = (length / 2 for length in reach(each.turn, (label.width, depth, tall)))
        boxes.append(((x - a, y - b, z - c), (x + a, y + b, z + c), False))
    return Group({number: (0.0, 0.0, 0.0)}, boxes)


def in_line(sized: Sequence[Sized], block: Block) -> Group:
    """A line of items that stand beside each other, on one level unless they are lifted."""
    members: dict[int, Vector] = {}
    boxes: list[tuple[Vector, Vector, bool]] = []
    for number, (x, y) in block.members.items():
        each = sized[number]
        aside = each.footprint.center
        height = reach(each.turn, each.size)[2] / 2 if each.lift is None else each.lift
        center = (x + aside[0], y + aside[1], height)
        members[number] = center
        boxes.extend(
            (moved(low, center), moved(high, center), is_body)
            for low, high, is_body in alone(each, number).boxes
        )
    return Group(members, boxes)


def placed_by_stress(
    groups: Sequence[Group],
    joined: Sequence[Sequence[int]],
    thickness: float,
    mode: Mode,
    stood: Stood,
    progress: Progress,
    spacing: float,
) -> list[Vector]:
    """Origins of all ``groups``; ``joined`` are the groups, by number, that each hyperedge joins.

    Coordinates that the mode leaves open are 0.
    """
    axes = list(AXES[mode])
    boxes = _boxes(groups, axes)
    places = np.zeros((len(groups), len(axes)))
    for number, place in stood.places.items():
        places[number] = np.array(place)[axes]
    has_place = np.zeros(len(groups), dtype=np.bool_)
    has_place[list(stood.places)] = True
    held = np.zeros(len(groups), dtype=np.bool_)
    held[list(stood.held)] = True
    starts = starts_of(np.array([len(each) for each in joined], dtype=np.int64))
    members = np.array([number for each in joined for number in each], dtype=np.int64)
    graph = Hypergraph(
        _radii(boxes, len(groups)),
        boxes,
        starts,
        members,
        thickness,
        places,
        has_place,
        held,
        spacing,
    )
    whole = np.zeros((len(groups), 3))
    whole[:, axes] = arranged(graph, progress)
    return [(x, y, z) for x, y, z in whole.tolist()]


def _boxes(groups: Sequence[Group], axes: list[int]) -> Boxes:
    corners = np.array(
        [(low, high) for group in groups for low, high, _ in group.boxes], dtype=np.float64
    ).reshape(-1, 2, 3)
    return Boxes(
        np.ascontiguousarray(corners[:, 0, axes]),
        np.ascontiguousarray(corners[:, 1, axes]),
        np.repeat(np.arange(len(groups)), [len(group.boxes) for group in groups]),
        np.array([is_body for group in groups for _, _, is_body in group.boxes], dtype=np.bool_),
    )


def _radii(boxes: Boxes, count: int) -> Floats:
    """Half the geometric mean of the sides of what is around all bodies of a group, (n,)."""
    lows, highs = (np.full((count, boxes.lows.shape[1]), sign * np.inf) for sign in (1, -1))
    rows = boxes.owners[boxes.are_bodies]
    np.minimum.at(lows, rows, boxes.lows[boxes.are_bodies])
    np.maximum.at(highs, rows, boxes.highs[boxes.are_bodies])
    return np.asarray(0.5 * np.prod(highs - lows, axis=1) ** (1.0 / lows.shape[1]))


def by_stress(
    sized: Sequence[Sized],
    children: Sequence[int],
    blocks: Sequence[Block],
    joined: Sequence[Sequence[int]],
    thickness: float,
    mode: Mode,
    progress: Progress,
    spacing: float = 1.0,
) -> dict[int, Vector]:
    """Where the solids' centres of the free ones of ``children`` are, seen from their parent.

    ``blocks`` are the free ones, in order; ``joined`` are the children that each hyperedge joins.
    What has a position is held. So is what stood as it does, elsewhere than on the ground; what
    has changed leaves its place, and is no more said to have stood, where there is no room for it.
    """
    groups = [alone(sized[child], child) for child in children if not sized[child].is_free]
    fixed = [sized[child] for child in children if not sized[child].is_free]
    places = {
        number: moved(each.item.position or (0.0, 0.0, 0.0), each.middle)
        for number, each in enumerate(fixed)
    }
    held = set(places)
    for block in blocks:
        first = next(iter(block.members))
        group = alone(sized[first], first) if len(block.members) == 1 else in_line(sized, block)
        stood = [sized[member].stood for member in block.members]
        if mode != "ground" and all(each is not None for each in stood):
            a, b, c = group.members[first]
            offset = (0.0, 0.0, 0.0) if stood[0] is None else stood[0].offset
            places[len(groups)] = moved(offset, (-a, -b, -c))
            if all(sized[member].is_as_before for member in block.members):
                held.add(len(groups))
        groups.append(group)
    numbers = {member: number for number, group in enumerate(groups) for member in group.members}
    together = [list(dict.fromkeys(numbers[child] for child in each)) for each in joined]
    edges = [each for each in together if len(each) > 1]
    origins = placed_by_stress(
        groups, edges, thickness, mode, Stood(places, frozenset(held)), progress, spacing
    )
    depth = sum(place[1] for place in places.values()) / max(len(places), 1)
    found: dict[int, Vector] = {}
    for number, (group, (x, y, z)) in enumerate(zip(groups, origins, strict=True)):
        before = places.get(number)
        within = depth if before is None else before[1]
        origin = (x, within if mode == "sheet" else y, z)
        for member, offset in group.members.items():
            each = sized[member]
            found[member] = moved(origin, offset)
            if number not in held and each.stood is not None and origin != before:
                each.stood = None
    return found
