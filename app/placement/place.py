"""Places for all items of a program, and for the ends of all its hyperedges."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from app.notations.notation import Notation
from app.placement.attaching import attached
from app.placement.choosing import mode_of
from app.placement.contents import measure
from app.placement.contents_by_stress import Stress
from app.placement.family import Family, family
from app.placement.joined import joined
from app.placement.labels import label_place
from app.placement.layers.place import in_layers
from app.placement.layers.terminals import TooManyError
from app.placement.modes import BY_STRESS, Mode
from app.placement.placement import LabelPlace, Placement
from app.placement.rooms import TOUCHING
from app.placement.sized import Place, Sized
from app.placement.standing import Standing
from app.placement.stress.arrange import silent
from app.placement.stress.pairs import Progress
from app.placement.turning import UNTURNED, Quaternion, Vector, moved, reach, then
from app.placement.untouched import untouched
from app.placement.within import in_parent
from app.program.model import Program
from app.solids.extents import middle_of
from app.solids.solid import Tray


def place(
    program: Program,
    notation: Notation,
    standing: Standing | None = None,
    progress: Progress = silent,
    spacing: float = 1.0,
) -> Placement:
    """The places of all items and attachments. Raises what `app.solids.csg.make_body` does.

    Items with positions stay exactly there; the others go where the document's placement puts them:
    in rows within their parents or on the plane z = 0, or beside what they are joined to. After an
    edit, what is ``standing`` stays there to the last bit, but for what the edit concerns: new and
    changed items, and what holds them, which grows around them. What would have to grow over others
    moves to a free place, with all that is in it. Where items are placed in another mode than
    before, all are placed anew. ``progress`` may raise to end the work. What is placed by what
    hyperedges join is ``spacing`` times as far apart as usual.
    """
    mode = mode_of(program, standing)
    if standing is not None and standing.mode != mode:
        standing = None
    rest = None if standing is None else untouched(program, standing)
    if rest is None:
        placed = _placed(program, notation, standing, mode, progress, spacing)
    else:
        placed = rest.beside(_placed(rest.others, notation, standing, mode, progress, spacing))
    radii = [
        hyperedge.radius or notation.hyperedge_style(hyperedge.kind).radius
        for hyperedge in program.hyperedges
    ]
    placed = replace(placed, radii=np.array(radii, dtype=np.float64))
    if mode == "layers" and standing is None:
        with suppress(TooManyError):
            return in_layers(program, notation, placed)
        placed = replace(placed, mode="rows")
    return attached(program, placed, standing)


def _placed(
    program: Program,
    notation: Notation,
    standing: Standing | None,
    mode: Mode,
    progress: Progress,
    spacing: float,
) -> Placement:
    """The items alone, without attachments."""
    relations = family(program)
    stress = None
    if mode in BY_STRESS:
        stress = Stress(mode, joined(program, relations, notation), progress, spacing)
    styles = [notation.item_style(item.kind) for item in program.items]
    sized, roots = measure(program, relations, styles, standing, stress)
    centers, turns, offsets = _in_world(sized, relations, roots)
    nothing = np.empty((0, 3))
    return Placement(
        centers=np.array(centers, dtype=np.float64).reshape(-1, 3),
        rotations=np.array(turns, dtype=np.float64).reshape(-1, 4),
        sizes=np.array([each.size for each in sized], dtype=np.float64).reshape(-1, 3),
        solids=tuple(each.solid for each in sized),
        labels=tuple(_label(each) for each in sized),
        attachment_positions=nothing,
        attachment_directions=nothing,
        attachment_starts=np.zeros(1, dtype=np.int64),
        attachment_items=np.empty(0, dtype=np.int64),
        radii=np.empty(0),
        parents=np.array(relations.parents, dtype=np.int64),
        offsets=np.array(offsets, dtype=np.float64).reshape(-1, 3),
        turns=np.array([each.turn for each in sized], dtype=np.float64).reshape(-1, 4),
        mode=mode,
    )


def _in_world(
    sized: Sequence[Sized], relations: Family, roots: dict[int, Place]
) -> tuple[list[Vector], list[Quaternion], list[Vector]]:
    """Centres and turns in the world, and offsets from the parent's origin."""
    centers: list[Vector] = [(0.0, 0.0, 0.0)] * len(sized)
    turns: list[Quaternion] = [UNTURNED] * len(sized)
    offsets: list[Vector] = [(0.0, 0.0, 0.0)] * len(sized)
    still = [False] * len(sized)
    for number in relations.order:
        each = sized[number]
        parent = relations.parents[number]
        stood = each.stood
        offset = offsets[number] = _offset(sized, number, parent, roots)
        if (
            stood is not None
            and stood.center is not None
            and each.is_as_it_stood(offset)
            and (parent < 0 or still[parent])
        ):
            # Not computed again, which could differ in the last bit.
            centers[number], turns[number], still[number] = stood.center, stood.rotation, True
            continue
        if parent < 0:
            turns[number], centers[number] = each.turn, offset
        else:
            turns[number] = then(turns[parent], each.turn)
            centers[number] = in_parent(sized[parent].solid, centers[parent], turns[parent], offset)
        still[number] = stood is not None and (centers[number], turns[number]) == (
            stood.center,
            stood.rotation,
        )
    return centers, turns, offsets


def _offset(sized: Sequence[Sized], number: int, parent: int, roots: dict[int, Place]) -> Vector:
    """Where an item's solid has its centre, seen from its parent's origin."""
    each = sized[number]
    if each.item.position is not None:
        return moved(each.item.position, each.middle)
    rise = reach(each.turn, each.size)[2] / 2 if each.lift is None else each.lift
    stood = each.stood
    if stood is None or not stood.alike:
        x, y = roots[number] if parent < 0 else sized[parent].children[number]
    elif parent < 0 or sized[parent].is_alike:
        return stood.offset
    else:
        x, y, _ = stood.offset
    height = rise if parent < 0 else _ground(sized[parent]) + rise
    if stood is not None and abs(height - stood.offset[2]) <= TOUCHING:
        height = stood.offset[2]
    return (x, y, height)


def _ground(parent: Sized) -> float:
    """What children stand on: a tray's floor, or the top of anything else; about its origin."""
    if isinstance(parent.solid, Tray):
        return parent.solid.floor - parent.size[2] / 2
    return parent.size[2] / 2 + middle_of(parent.solid)[2]


def _label(each: Sized) -> LabelPlace | None:
    if each.label is None or each.item.label is None:
        return None
    return label_place(
        each.item.label,
        each.style.label_height,
        each.label,
        each.solid,
        each.size,
        each.style.padding,
        side=each.style.caption == "left",
    )
