"""Sweeping tubes, beside VTK's tube filter on the same polylines in the same run."""

from __future__ import annotations

from collections.abc import Callable
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
    return np.asarray(np.repeat(first, lengths) + within)


def vtk_filter(points: Floats, starts: Indices) -> Any:
    """VTK's tube filter over the same polylines: as many sides, open ends, smooth normals."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkTubeFilter

    # VTK's own typing stops short of these two.
    to_vtk: Callable[..., Any] = numpy_to_vtk
    to_ids: Callable[..., Any] = numpy_to_vtkIdTypeArray
    places = vtkPoints()
    places.SetData(to_vtk(points.astype(np.float32), deep=True))
    lines = vtkCellArray()
    lines.SetData(
        to_ids(starts, deep=True), to_ids(np.arange(len(points), dtype=np.int64), deep=True)
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


@pytest.fixture(scope="module", params=[(999, 30), (99_999, 3)], ids=lambda param: str(param[0]))
def routing_and_rounds(request: pytest.FixtureRequest) -> tuple[Routing, int]:
    """Hyperedges of so many segments together, and how often to sweep them."""
    segments, rounds = request.param
    return routing_of(segments // 3), rounds


def _note(benchmark: Any, routing: Routing, vertices: int) -> None:
    segments = len(routing.control_points)
    nanoseconds = 1e9 * benchmark.stats.stats.median / vertices
    benchmark.extra_info["for each vertex"] = f"{nanoseconds:.1f} ns"
    benchmark.extra_info["rings a tube"] = f"{vertices / segments / SIDES:.1f}"


def test_sweep_tubeloom(benchmark: Any, routing_and_rounds: tuple[Routing, int]) -> None:
    """Ours: positions, normals, indices, rounded ends."""
    routing, rounds = routing_and_rounds
    benchmark.group = f"Tubes of {len(routing.control_points):,} segments, {SIDES} sides"
    made = benchmark.pedantic(sweep, (routing, TOLERANCE), rounds=rounds, warmup_rounds=1)
    _note(benchmark, routing, len(made.vertices))


def test_vtk_tube_filter(benchmark: Any, routing_and_rounds: tuple[Routing, int]) -> None:
    """What a user would pick: the same polylines, as many sides, normals."""
    routing, rounds = routing_and_rounds
    benchmark.group = f"Tubes of {len(routing.control_points):,} segments, {SIDES} sides"
    tubes = vtk_filter(*axes_of(routing))

    def update() -> None:
        tubes.Modified()
        tubes.Update()

    benchmark.pedantic(update, rounds=(rounds + 2) // 3, warmup_rounds=1)
    assert tubes.GetOutput().GetPointData().GetNormals() is not None
    _note(benchmark, routing, tubes.GetOutput().GetNumberOfPoints())
