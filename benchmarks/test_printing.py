"""Prints: uniting tubes, and whole programs to files; trimesh's union of the same tubes beside."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.formats import registry
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.output.shells import triangles_of
from app.output.stl import write_stl
from app.output.threemf import write_3mf
from app.settings import Settings
from app.staging import bodies_for_print, make_scene
from app.tubes.sweep import sweep
from app.tubes.tubes import Tubes
from app.tubes.unions import TubePlan, plan_unions, unite
from tests.hyperedges.scenes import placement

EXAMPLES = Path(__file__).parents[1] / "examples"
PROGRAMS = {
    "id3-clause-1": "tubeloom",
    "id3-clause-2": "tubeloom",
    "yosys/up3down5": "yosys",
}
SHARE = 0.02


def plan_of(routing: Routing) -> TubePlan:
    """Rings of all tubes, as the pipeline plans them."""
    return plan_unions(routing, SHARE * routing.radii)


def capsules(routing: Routing) -> list[list[Any]]:
    """For each hyperedge its segments as closed meshes for trimesh: one stretch, rounded ends."""
    import trimesh

    alone = Routing(
        control_points=routing.control_points,
        segment_starts=np.arange(len(routing.control_points) + 1),
        segment_ends=np.tile([0, 1], (len(routing.control_points), 1)),
        join_positions=np.zeros((0, 3)),
        join_tangents=np.zeros((0, 3)),
        join_starts=np.zeros(len(routing.control_points) + 1, dtype=np.int64),
        join_planes=np.zeros(len(routing.control_points)),
        radii=np.repeat(routing.radii, np.diff(routing.segment_starts)),
    )
    tubes = sweep(alone, SHARE * alone.radii)
    meshes = [tubes.mesh(segment) for segment in range(len(alone.radii))]
    closed = [trimesh.Trimesh(mesh.vertices, mesh.faces, process=False) for mesh in meshes]
    starts = routing.segment_starts
    return [closed[starts[k] : starts[k + 1]] for k in range(len(routing.radii))]


HYPEREDGES, ATTACHMENTS = 50, 4
GROUP = f"Unions of {HYPEREDGES} hyperedges of {2 * ATTACHMENTS - 3} segments"


def routing() -> Routing:
    """Short trees between places far enough apart that no tube bends too tightly."""
    chance = np.random.default_rng(1)
    corners = np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]])
    points = corners + chance.uniform(-1, 1, (HYPEREDGES, ATTACHMENTS, 3)) * [1, 1, 0.2]
    starts = ATTACHMENTS * np.arange(HYPEREDGES + 1)
    return route(placement(points.reshape(-1, 3), starts.tolist()), clearance=None)


def test_unite_tubeloom(benchmark: Any) -> None:
    """Ours: every hyperedge one body, cut where it would overlap itself, and checked."""
    benchmark.group = GROUP
    curves, names = routing(), [str(number) for number in range(HYPEREDGES)]
    found: Tubes = benchmark.pedantic(
        lambda: unite(plan_of(curves), names), rounds=3, warmup_rounds=1
    )
    each = 1e3 * benchmark.stats.stats.median / HYPEREDGES
    benchmark.extra_info["for each"] = f"{each:.1f} ms"
    benchmark.extra_info["triangles"] = f"{len(found.faces):,}"


def test_unite_trimesh(benchmark: Any) -> None:
    """What a user would pick: trimesh's union of the same segments as closed tubes."""
    import trimesh

    benchmark.group = GROUP
    parts = capsules(routing())

    def unite_all() -> list[Any]:
        return [
            trimesh.boolean.union(part, engine="manifold", check_volume=False) for part in parts
        ]

    found = benchmark.pedantic(unite_all, rounds=3, warmup_rounds=1)
    whole = sum(body.is_watertight and body.body_count == 1 for body in found)
    benchmark.extra_info["in one closed piece"] = f"{whole} of {HYPEREDGES}"


@pytest.mark.parametrize("form", ["stl", "3mf"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_print_a_program(benchmark: Any, name: str, form: str) -> None:
    """Read, placed, laid out, united, written."""
    benchmark.group = f"{name}.json to {form}"
    data = (EXAMPLES / f"{name}.json").read_bytes()
    write = write_stl if form == "stl" else write_3mf

    def make() -> bytes:
        program = registry.read(PROGRAMS[name], data, Settings())
        scene = make_scene(program, 4 / 3, sweeping=bodies_for_print(10**9))
        benchmark.extra_info["hyperedges"] = len(program.hyperedges)
        benchmark.extra_info["triangles"] = f"{triangles_of(scene, 'all'):,}"
        return write(scene)

    file = benchmark.pedantic(make, rounds=3, warmup_rounds=1)
    benchmark.extra_info["kB"] = len(file) // 1000
