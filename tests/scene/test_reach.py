from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from app.arrays import Floats
from app.scene.reach import Reach
from app.scene.scene import Node, Primitive
from app.solids.meshing import mesh_of
from app.solids.solid import Arrow, Box, Cone, Solid, Sphere

SOLIDS: tuple[Solid, ...] = (
    Box((2.0, 1.0, 0.2), 0.05),
    Sphere(0.7),
    Cone(0.5, 2.0),
    Arrow(3.0, 0.4),
)


def random_nodes(seed: int, count: int) -> tuple[list[Node], Floats]:
    """Nodes of several solids, turned and moved at random, and their boxes."""
    chance = np.random.default_rng(seed)
    nodes, boxes = [], []
    for number in range(count):
        meshes = [mesh_of(SOLIDS[index]) for index in chance.integers(0, 4, chance.integers(1, 3))]
        x, y, z, w = Rotation.random(random_state=chance).as_quat().tolist()
        a, b, c = chance.uniform(-5, 5, 3).tolist()
        parts = tuple(Primitive(mesh, 0) for mesh in meshes)
        nodes.append(Node(str(number), "item", parts, (a, b, c), (x, y, z, w), {}))
        bounds = np.array([mesh.bounds for mesh in meshes])
        boxes.append([bounds[:, 0].min(axis=0), bounds[:, 1].max(axis=0)])
    return nodes, np.array(boxes)


def world_vertices(nodes: list[Node]) -> Floats:
    """All vertices of all nodes, in the world."""
    return np.concatenate(
        [
            Rotation.from_quat(node.rotation).apply(part.mesh.vertices) + node.translation
            for node in nodes
            for part in node.primitives
        ]
    )


@settings(max_examples=50)
@given(st.integers(0, 10_000), st.integers(1, 12))
def test_no_vertex_lies_farther_and_the_answer_is_a_vertex(seed: int, count: int) -> None:
    nodes, boxes = random_nodes(seed, count)
    reach, vertices = Reach.of(nodes, boxes), world_vertices(nodes)
    for direction in np.random.default_rng(seed).normal(size=(5, 3)):
        farthest = reach.farthest(direction)
        assert farthest @ direction == pytest.approx((vertices @ direction).max(), abs=1e-12)
        assert np.linalg.norm(vertices - farthest, axis=1).min() < 1e-12


def test_bounds_are_those_of_the_vertices_and_not_of_turned_boxes() -> None:
    nodes, boxes = random_nodes(3, 6)
    vertices = world_vertices(nodes)
    expected = np.array([vertices.min(axis=0), vertices.max(axis=0)])
    assert Reach.of(nodes, boxes).bounds == pytest.approx(expected, abs=1e-12)


def test_nodes_without_triangles_reach_nowhere() -> None:
    blank = Node("blank", "item", (), (1e6, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), {})
    nodes, boxes = random_nodes(1, 2)
    with_blank = Reach.of([blank, *nodes], np.concatenate([np.zeros((1, 2, 3)), boxes]))
    assert np.array_equal(with_blank.bounds, Reach.of(nodes, boxes).bounds)
    assert not Reach.of([blank], np.zeros((1, 2, 3))).bounds.any()
