from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.hulls import hull
from app.solids.extents import size_of
from app.solids.meshing import mesh_of
from app.solids.solid import Arrow, Box, Cone, Cylinder, Solid, Sphere, Text, Tray

SOLIDS: dict[str, Solid] = {
    "box": Box((1.0, 2.0, 0.5), 0.05),
    "tray": Tray((3.0, 2.0, 0.5), 0.1, 0.06),
    "thick tray": Tray((1.0, 2.0, 0.5), 5.0, 5.0),
    "sphere": Sphere(0.7),
    "cylinder": Cylinder(0.5, 2.0, 0.05),
    "cone": Cone(0.5, 2.0),
    "arrow": Arrow(3.0, 0.4),
    "short arrow": Arrow(0.5, 0.4),
    "text": Text("Big jolly", 0.5, 0.1),
}


def distances(points: Floats, solid: Solid) -> Floats:
    """How far points (n, 3) are outside the hull of a solid."""
    boxes = hull(solid, size_of(solid))
    local = np.einsum("kji,nkj->nki", boxes.rotations, points[:, None] - boxes.centers)
    beyond = np.maximum(np.abs(local) - boxes.halves, 0)
    found: Floats = (np.linalg.norm(beyond, axis=2) - boxes.roundings).min(axis=1)
    return found


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_lies_in_the_union_of_its_boxes(name: str) -> None:
    mesh = mesh_of(SOLIDS[name])
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    weights = np.random.default_rng(0).dirichlet(np.ones(3), (len(corners), 8))
    points = np.einsum("fkc,fcx->fkx", weights, corners).reshape(-1, 3)
    assert distances(np.concatenate([points, mesh.vertices]), SOLIDS[name]).max() < 1e-6


@pytest.mark.parametrize(
    ("name", "place", "least"),
    [
        ("sphere", (0.5, 0.5, 0.5), 0.16),
        ("cylinder", (0.4, 0.4, 0.0), 0.02),
        ("cone", (0.3, 0.0, 0.9), 0.15),
        ("arrow", (-1.0, 0.25, 0.25), 0.1),
        ("tray", (0.0, 0.0, 0.1), 0.2),
    ],
)
def test_what_is_beside_a_solid_is_outside_its_boxes(
    name: str, place: tuple[float, float, float], least: float
) -> None:
    assert distances(np.array([place]), SOLIDS[name])[0] > least
