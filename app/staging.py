"""From a program to its scene: layout, tubes, assembly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from app.answers import Delta
from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.layout import Layout, Progress, lay_out, silent
from app.notations.loader import load_notation
from app.output.shells import refuse_too_many
from app.program.model import Program
from app.scene.assemble import assemble
from app.scene.camera import view_of
from app.scene.detail import Detail
from app.scene.scene import Scene
from app.tubes.patches import patch_tubes
from app.tubes.sweep import sweep
from app.tubes.tubes import Tubes
from app.tubes.unions import plan_unions, unite
from app.tubes.unswept import UnsweptTubes

TUBE_TOLERANCE = 0.02
"""How far a mesh may be from its tube, as a share of the thinnest radius: some 16 sides. Further
where no picture of the size asked for could show it; see `app.scene.detail`."""

Sweeping = Callable[[Program, Routing, float | Floats], Tubes | UnsweptTubes]
"""Makes tubes that are off by no more than a tolerance: one for all, or one for each (h,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Staged:
    """A scene, and the layout that it shows."""

    layout: Layout
    scene: Scene


def make_scene(
    program: Program,
    aspect: float,
    progress: Progress = silent,
    sweeping: Sweeping | None = None,
    height: int | None = None,
    layout: Layout | None = None,
) -> Scene:
    """The scene alone of `stage`."""
    return stage(program, aspect, progress, sweeping, height, layout).scene


def stage(
    program: Program,
    aspect: float,
    progress: Progress = silent,
    sweeping: Sweeping | None = None,
    height: int | None = None,
    layout: Layout | None = None,
) -> Staged:
    """Place, route, make tubes, assemble: everything between reading and writing.

    Where there is a ``layout`` already, it is shown. Tubes are what ``sweeping`` (`make_tubes`)
    makes. They and items are no finer than shows in a picture ``height`` pixels high, where there
    is one.
    """
    laid = layout or lay_out(program, progress=progress)
    progress("making tubes", 0.4)
    coarse = _coarseness(laid, laid.routing, aspect, height)
    tubes = (sweeping or make_tubes)(program, laid.routing, coarse.tubes)
    progress("assembling the scene", 0.5)
    notation = load_notation(program.notation)
    scene = assemble(program, notation, laid.placement, tubes, aspect, laid.hues, coarse.items)
    return Staged(laid, scene)


def stage_changes(layout: Layout, delta: Delta, aspect: float, height: int) -> Scene:
    """A scene of what changed alone: items and hyperedges, each a node of its own.

    The ground and its shadows are those of the whole scene; the camera looks at what changed.
    """
    whole, placement = layout.program, layout.placement
    items = [number for number, item in enumerate(whole.items) if item.id in delta.items]
    hyperedges = np.array(
        [number for number, each in enumerate(whole.hyperedges) if each.id in delta.hyperedges],
        dtype=np.int64,
    )
    program = whole.model_copy(
        update={
            "items": tuple(whole.items[number] for number in items),
            "hyperedges": tuple(whole.hyperedges[number] for number in hyperedges.tolist()),
            "style": whole.style.model_copy(update={"ground": False}),
        }
    )
    shown = replace(
        placement,
        centers=placement.centers[items],
        rotations=placement.rotations[items],
        sizes=placement.sizes[items],
        solids=tuple(placement.solids[number] for number in items),
        labels=tuple(placement.labels[number] for number in items),
        radii=placement.radii[hyperedges],
    )
    routing = layout.routing.part(hyperedges)
    coarse = _coarseness(layout, routing, aspect, height)
    tubes = make_tubes(program, routing, coarse.tubes)
    notation = load_notation(program.notation)
    scene = assemble(program, notation, shown, tubes, aspect, layout.hues[hyperedges], coarse.items)
    removed = {
        "items": list(delta.removed_items),
        "hyperedges": list(delta.removed_hyperedges),
    }
    told = {"since": delta.since, "revision": delta.revision, "removed": removed}
    return replace(scene, extras={"delta": told})


def make_tubes(program: Program, routing: Routing, tolerance: float | Floats) -> Tubes:
    """Tubes around the curves, as the document's ``layout`` wishes."""
    if not program.hyperedges:
        return Tubes.none()
    if program.layout.tube == "patches":
        return patch_tubes(routing, program.layout.patch_rule, tolerance)
    return sweep(routing, tolerance)


def make_crowd(_program: Program, routing: Routing, tolerance: float | Floats) -> UnsweptTubes:
    """Tubes of very many hyperedges, which are made when they are written."""
    return UnsweptTubes.of(routing, tolerance)


def bodies_for_print(most: int, progress: Progress = silent) -> Sweeping:
    """Makes tubes for printing: each hyperedge one closed body, of ``most`` triangles together."""
    return partial(_make_bodies, most=most, progress=progress)


def _make_bodies(
    program: Program, routing: Routing, _tolerance: float | Floats, *, most: int, progress: Progress
) -> Tubes:
    if not program.hyperedges:
        return Tubes.none()
    plan = plan_unions(routing, TUBE_TOLERANCE * routing.radii)
    refuse_too_many(plan.triangles, most)
    names = [hyperedge.id for hyperedge in program.hyperedges]
    return unite(plan, names, lambda share: progress("making tubes", 0.4 + 0.1 * share))


class _Coarseness(NamedTuple):
    """How far meshes may be off: those of tubes, all or each of h hyperedges (h,); and of items."""

    tubes: float | Floats
    items: float


def _coarseness(layout: Layout, routing: Routing, aspect: float, height: int | None) -> _Coarseness:
    """For the tubes of ``routing``, a part of the layout's or all, and for items.

    No more than shows in a picture of the whole, ``height`` pixels high, where there is one.
    """
    finest = TUBE_TOLERANCE * float(layout.routing.radii.min(initial=1.0))
    if height is None:
        return _Coarseness(finest, 0.0)
    view = view_of(layout.program, layout.placement.mode)
    detail = Detail.of(layout.placement, layout.routing, view, aspect, height)
    tubes = detail.tubes(routing, finest) if len(routing.radii) else finest
    return _Coarseness(tubes, detail.items())
