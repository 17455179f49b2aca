from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.layout import lay_out
from app.program.model import Program
from app.scene.grain import ACROSS, textured_tubes
from app.scene.strands import strands_of
from app.solids.mesh import Mesh
from app.solids.meshing import mesh_of
from app.solids.solid import Box, Text
from app.staging import make_tubes


def tubes_of(count: int, **layout: Any) -> Mesh:
    """The tubes of a hyperedge that joins so many items."""
    program = Program.model_validate(
        {
            "items": [
                {"id": str(number), "position": [1.7 * number, number % 2, number % 3]}
                for number in range(count)
            ],
            "hyperedges": [
                {"id": "h", "attachments": [{"item": str(number)} for number in range(count)]}
            ],
            "layout": layout,
        }
    )
    return make_tubes(program, lay_out(program).routing, 0.002).mesh(0)


def spread(values: Floats, groups: Indices) -> float:
    """The largest difference of values within a group."""
    high = np.full(groups.max() + 1, -np.inf)
    low = -high
    np.maximum.at(high, groups, values)
    np.minimum.at(low, groups, values)
    return float((high - low).max())


@pytest.mark.parametrize("count", [2, 3, 4, 7])
def test_strands_go_on_over_joins(count: int) -> None:
    mesh = tubes_of(count)
    strands = strands_of(mesh)
    assert strands is not None
    _, places = np.unique(mesh.vertices, axis=0, return_inverse=True)
    places = places.reshape(-1)
    assert len(places) > places.max() + 1 or count == 2, "joins are shared"
    assert spread(strands.along, places) < 1e-6
    assert spread(strands.around, places) == 0


@pytest.mark.parametrize("count", [2, 5])
def test_vertices_are_as_far_along_as_their_edges_are_long(count: int) -> None:
    mesh = tubes_of(count)
    strands = strands_of(mesh)
    assert strands is not None
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [0, 2]]]).astype(np.int64)
    edges = edges[np.ptp(strands.around[edges], axis=1) == 0]
    lengths = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    steps = np.abs(strands.along[edges[:, 0]] - strands.along[edges[:, 1]])
    is_inside = lengths < steps
    assert steps.sum() == pytest.approx(lengths.sum(), rel=0.15)
    assert 0.3 < is_inside.mean() < 0.7, "shorter inside of bends, longer outside"
    assert strands.along.min() == 0
    assert strands.along.max() > 1.7 * (count - 1), "from the first item to the last"


def test_strands_run_from_one_side_to_the_other_and_back() -> None:
    mesh = tubes_of(2)
    strands = strands_of(mesh)
    assert strands is not None
    values = np.unique(strands.around)
    ring = strands.around[1 : 1 + 2 * (len(values) - 1)]
    assert values[0] == ring[0] == 0
    assert values[-1] == 1
    assert np.array_equal(ring[1:], ring[1:][::-1]), "mirrored"


def test_the_grain_is_as_wide_around_a_tube_as_on_a_solid() -> None:
    mesh = tubes_of(2)
    found = textured_tubes(mesh, "wood", 0.1).coordinates
    assert found is not None
    assert np.ptp(found[:, 1]) == pytest.approx(np.pi * 0.1 / ACROSS, rel=1e-5)
    assert found.dtype == np.float32


def test_patches_have_strands_too() -> None:
    for rule in ("paper", "fitted"):
        strands = strands_of(tubes_of(4, tube="patches", patch_rule=rule))
        assert strands is not None
        assert np.isfinite(strands.along).all()
        assert set(np.unique(np.diff(np.unique(strands.around)).round(6))) != {0.0}


@pytest.mark.parametrize("solid", [Box((1.0, 1.0, 1.0), 0.05), Text("Rg", 0.3, 0.1)])
def test_solids_have_no_strands(solid: Box | Text) -> None:
    assert strands_of(mesh_of(solid)) is None


def test_two_triangles_have_no_strands() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=np.float32)
    for faces in ([[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]):
        assert strands_of(Mesh(vertices, vertices, np.array(faces, dtype=np.uint32))) is None
