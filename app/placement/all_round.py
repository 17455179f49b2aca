"""Ends of hyperedges on all sides of items that stand on nothing: each towards what it joins."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.arrays import Flags, Floats, Indices
from app.placement.balls import spread_on_balls, towards
from app.placement.placement import Placement
from app.placement.slots import all_round_slots
from app.placement.spreading import PITCHES, assigned, free_slots
from app.placement.turning import matrices
from app.program.model import Program
from app.solids.solid import Sphere

TILT = 0.06
"""Of the directions of single hyperedges to the front or the back, at most, document units."""

PITCH = 1.2
"""Between ends on a ball, over two radii and the clearance."""

SHIFT = 0.3
"""How far hyperedges that join the same items are shifted from each other, over the same, times the
square root of their number: so parallel ones stay parallel."""

TURN = np.pi * (3.0 - np.sqrt(5.0))
"""The golden angle."""


def all_round(program: Program, placement: Placement, held: Flags) -> Placement:
    """The placement with the ends at no named point where their hyperedges go.

    They leave a ball anywhere, and a block or a cylinder from any side but the front. Those that
    are ``held`` (a,) stay.
    """
    ends = [end.point is None for each in program.hyperedges for end in each.attachments]
    rows = np.flatnonzero(np.array(ends, dtype=np.bool_))
    if len(rows) == 0 or held[rows].all():
        return placement
    ways = _ways(program, placement)
    rows = rows[np.argsort(placement.attachment_items[rows], kind="stable")]
    of_items = np.split(rows, np.flatnonzero(np.diff(placement.attachment_items[rows])) + 1)
    balls: list[Indices] = []
    others: list[Indices] = []
    for each in of_items:
        item = int(placement.attachment_items[each[0]])
        (balls if isinstance(placement.solids[item], Sphere) else others).append(each)
    positions = placement.attachment_positions.copy()
    directions = placement.attachment_directions.copy()
    if balls:
        _on_balls(program, placement, balls, ways, held, positions, directions)
    for each in others:
        _on_faces(program, placement, each, ways, held, positions, directions)
    return replace(placement, attachment_positions=positions, attachment_directions=directions)


def _ways(program: Program, placement: Placement) -> Floats:
    """From the centres of items to where their ends would like to lead (a, 3), document units.

    To what else the hyperedge joins, and beside that what shifts it.
    """
    starts, items = placement.attachment_starts, placement.attachment_items
    counts = np.diff(starts)
    owners = np.repeat(np.arange(len(counts)), counts)
    ways = towards(placement.centers[items], starts)
    lengths = np.linalg.norm(ways, axis=1, keepdims=True)
    ways = np.divide(ways, lengths, out=np.zeros_like(ways), where=lengths > 1e-9)
    reaches = 0.5 * placement.sizes[items].min(axis=1)
    return np.asarray(ways * reaches[:, None] + _shifts(program, placement)[owners])


def _shifts(program: Program, placement: Placement) -> Floats:
    """One constant shift for each hyperedge (h, 3), by those that join the same items."""
    items, starts = placement.attachment_items.tolist(), placement.attachment_starts.tolist()
    groups: dict[tuple[int, ...], list[int]] = {}
    for number in range(len(placement.radii)):
        same = tuple(sorted(set(items[starts[number] : starts[number + 1]])))
        groups.setdefault(same, []).append(number)
    shifts = np.zeros((len(placement.radii), 3))
    # What lies on one sheet leaves a little before or behind it: else there is no way apart.
    numbers = np.arange(len(shifts)) * TURN / np.pi
    tilts = TILT * (2.0 * (numbers - np.floor(numbers)) - 1.0)
    clearance = program.layout.clearance or 0.0
    for place, members in enumerate(groups.values()):
        count = len(members)
        if count == 1:
            shifts[members, 1] = tilts[members]
            continue
        depths = (2.0 * np.arange(count) + 1.0) / count - 1.0
        angles = TURN * (np.arange(count) + place)
        rims = np.sqrt(1.0 - depths**2)
        ball = np.column_stack([rims * np.cos(angles), depths, rims * np.sin(angles)])
        thickness = 2.0 * float(placement.radii[members].max()) + clearance
        shifts[members] = SHIFT * thickness * np.sqrt(count) * ball
    return shifts


def _thickness(program: Program, placement: Placement, rows: Indices) -> float:
    """Of the thickest tube of these ends, with its clearance."""
    owners = np.searchsorted(placement.attachment_starts, rows, side="right") - 1
    return 2.0 * float(placement.radii[owners].max()) + (program.layout.clearance or 0.0)


def _on_balls(
    program: Program,
    placement: Placement,
    balls: list[Indices],
    ways: Floats,
    held: Flags,
    positions: Floats,
    directions: Floats,
) -> None:
    """Ends on the balls that these rows (e,) each are of, in place."""
    rows = np.concatenate(balls)
    starts = np.concatenate([[0], np.cumsum([len(each) for each in balls])])
    items = placement.attachment_items[rows]
    frames = matrices(placement.rotations[items])
    wanted = np.einsum("aji,aj->ai", frames, ways[rows])
    known = np.einsum(
        "aji,aj->ai", frames, placement.attachment_positions[rows] - placement.centers[items]
    )
    wanted = np.where(held[rows, None], known, wanted)
    lengths = np.linalg.norm(wanted, axis=1)
    wanted[lengths < 1e-9] = (0.0, 0.0, 1.0)
    wanted /= np.where(lengths < 1e-9, 1.0, lengths)[:, None]
    radii = 0.5 * placement.sizes[items, 0]
    needs = [
        PITCH * _thickness(program, placement, each) / (0.5 * placement.sizes[item, 0])
        for each, item in zip(balls, items[starts[:-1]].tolist(), strict=True)
    ]
    labelled = [placement.labels[item] is not None for item in items[starts[:-1]].tolist()]
    found = spread_on_balls(wanted, starts, np.array(needs), held[rows], np.array(labelled))
    outward = np.einsum("aij,aj->ai", frames, found)
    new = ~held[rows]
    places = placement.centers[items] + radii[:, None] * outward
    positions[rows[new]], directions[rows[new]] = places[new], outward[new]


def _on_faces(
    program: Program,
    placement: Placement,
    rows: Indices,
    ways: Floats,
    held: Flags,
    positions: Floats,
    directions: Floats,
) -> None:
    """Ends of one item that is no ball, in place."""
    item = int(placement.attachment_items[rows[0]])
    solid, size = placement.solids[item], placement.sizes[item]
    new = rows[~held[rows]]
    if len(new) == 0:
        return
    frame = matrices(placement.rotations[item : item + 1])[0]
    taken = (positions[rows[held[rows]]] - placement.centers[item]) @ frame
    thickness = _thickness(program, placement, rows)
    width, depth, height = size.tolist()
    for pitch in PITCHES:
        slots = all_round_slots(
            solid, (width, depth, height), len(rows), pitch * thickness, thickness
        )
        places, normals = free_slots(slots, taken, thickness)
        if len(places) >= len(new):
            break
    if len(places) == 0:
        return
    local = ways[new] @ frame
    # On the surface of the box around the item.
    scale = (np.abs(local) / (0.5 * size)).max(axis=1, keepdims=True)
    wanted = np.divide(local, scale, out=np.zeros_like(local), where=scale > 1e-9)
    lengths = np.linalg.norm(local, axis=1, keepdims=True)
    ways = np.divide(local, lengths, out=np.zeros_like(local), where=lengths > 1e-9)
    # A slot of another side costs what it would to be so far away.
    chosen = assigned(wanted, places, float((size**2).sum()) * (1.0 - ways @ normals.T))
    positions[new] = places[chosen] @ frame.T + placement.centers[item]
    directions[new] = normals[chosen] @ frame.T
