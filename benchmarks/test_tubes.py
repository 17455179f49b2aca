"""Sweeping tubes, beside VTK's tube filter on the same polylines in the same run."""

from __future__ import annotations

import gc
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.routing import Routing
from app.tubes.circle import cap_rings
from app.tubes.stacks import Stacks, stack_rings
from app.tubes.sweep import sweep
from app.tubes.tessellation import tessellation_of

SIDES, RADIUS = 12, 0.08
TOLERANCE = RADIUS * (1 - np.cos(np.pi / SIDES)) * (1 + 1e-9)

# Attachments as far apart as gives some 12 rings a tube at this tolerance.
SPREAD = 3.0


def routing_of(hyperedges: int) -> Routing:
    """Hyperedges of three attachments each, at random places, by the prose's formula."""
    chance = np.random.default_rng(1)
    attachments = chance.uniform(0, SPREAD, (hyperedges, 3, 3)) * [1, 1, 0.2]
    join = attachments.mean(axis=1)
    join[:, 2] = chance.uniform(1, 2, hyperedges)
    inside = (join + attachments[:, 0] + attachments[:, 1]) / 3
    following = 2 * join - inside
    curves = np.empty((hyperedges, 3, 4, 3))
    for k in range(2):
        curves[:, k, 0], curves[:, k, 1] = attachments[:, k], (attachments[:, k] + join) / 2
        curves[:, k, 2], curves[:, k, 3] = inside, join
    curves[:, 2, 0], curves[:, 2, 1] = join, following
    curves[:, 2, 2], curves[:, 2, 3] = (following + attachments[:, 2]) / 2, attachments[:, 2]
    tangents = join - inside
    return Routing(
        control_points=curves.reshape(-1, 4, 3),
        segment_starts=3 * np.arange(hyperedges + 1),
        segment_ends=np.tile([[0, 3], [1, 3], [3, 2]], (hyperedges, 1)),
        join_positions=join,
        join_tangents=tangents / np.linalg.norm(tangents, axis=1, keepdims=True),
        join_starts=np.arange(hyperedges + 1),
        join_planes=join[:, 2],
        radii=np.full(hyperedges, RADIUS),
    )


def axes_of(routing: Routing) -> tuple[Floats, Indices]:
    """The middles of our rings, without those of rounded ends, and where each polyline starts."""
    plan = tessellation_of(routing, TOLERANCE)
    assert (plan.sides == SIDES).all()
    caps = plan.ends.free * cap_rings(plan.sides)[:, None]
    stacks = stack_rings(
        routing.segment_starts, plan.sides, plan.rings.counts, caps, plan.ends.free
    )
    vertices = sweep(routing, TOLERANCE).vertices
    wanted = _tube_vertices(stacks, plan.rings.counts)
    middles = vertices[wanted].reshape(-1, SIDES, 3).astype(np.float64).mean(axis=1)
    return middles, np.concatenate([[0], np.cumsum(plan.rings.counts)])


def _tube_vertices(stacks: Stacks, counts: Indices) -> Indices:
    first = stacks.vertices[:-1] + stacks.poles[:, 0] + SIDES * stacks.cap_rings[:, 0]
    lengths = SIDES * counts
    within = np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    return np.repeat(first, lengths) + within


def vtk_filter(points: Floats, starts: Indices) -> Any:
    """VTK's tube filter over the same polylines: as many sides, open ends, smooth normals."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkTubeFilter

    places = vtkPoints()
    places.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
    lines = vtkCellArray()
    lines.SetData(
        numpy_to_vtkIdTypeArray(starts, deep=True),
        numpy_to_vtkIdTypeArray(np.arange(len(points), dtype=np.int64), deep=True),
    )
    polylines = vtkPolyData()
    polylines.SetPoints(places)
    polylines.SetLines(lines)
    tubes = vtkTubeFilter()
    tubes.SetInputData(polylines)
    tubes.SetRadius(RADIUS)
    tubes.SetNumberOfSides(SIDES)
    tubes.CappingOff()
    return tubes


def seconds(work: Callable[[], object], rounds: int) -> float:
    """The best time of some."""
    best = np.inf
    for _ in range(rounds):
        gc.collect()
        start = perf_counter()
        work()
        best = min(best, perf_counter() - start)
    return float(best)


@pytest.mark.parametrize(("segments", "rounds"), [(999, 30), (99_999, 3)])
def test_sweeping_tubes_beside_vtk(segments: int, rounds: int) -> None:
    """Ours is faster; by how much for each vertex is printed."""
    routing = routing_of(segments // 3)
    vertices = len(sweep(routing, TOLERANCE).vertices)
    ours = seconds(lambda: sweep(routing, TOLERANCE), rounds) / vertices

    tubes = vtk_filter(*axes_of(routing))

    def update() -> None:
        tubes.Modified()
        tubes.Update()

    theirs = seconds(update, (rounds + 2) // 3) / tubes.GetOutput().GetNumberOfPoints()
    assert tubes.GetOutput().GetPointData().GetNormals() is not None
    print(
        f"\n{segments} tubes of {vertices / segments / SIDES:.1f} x {SIDES} vertices with normals "
        f"and indices: ours {1e9 * ours:.1f} ns a vertex, vtkTubeFilter {1e9 * theirs:.0f} ns, "
        f"{theirs / ours:.1f} times as fast"
    )
    assert theirs > ours
