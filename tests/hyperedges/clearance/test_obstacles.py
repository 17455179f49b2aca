from __future__ import annotations

import numpy as np
import pytest

from app.hyperedges.clearance.obstacle_gaps import obstacle_gaps
from app.hyperedges.clearance.obstacles import obstacles_of
from app.solids.solid import Box, Cone, Text, Tray
from tests.hyperedges.clearance.furniture import furnished, label

LINE = np.column_stack([np.arange(4.0), np.zeros((4, 2))])
CUBE = Box((1.0, 1.0, 1.0), 0.05)


def test_a_tray_is_in_the_way_with_its_walls_and_not_with_its_inside() -> None:
    boxes = obstacles_of(furnished([Tray((8.0, 8.0, 2.0), 0.2, 0.2)], [[0, 0, 1.0]]))
    curves, radii = np.stack([LINE - [1.5, 0, 0], 2 * LINE]), np.full(2, 0.1)
    curves[..., 2] = 1.0
    pairs = np.stack(np.meshgrid([0, 1], np.arange(5), indexing="ij"), -1).reshape(-1, 2)
    found = obstacle_gaps(curves, radii, boxes, pairs, np.inf).lower.reshape(2, 5).min(axis=1)
    assert 0.68 < found[0] <= 0.7
    assert found[1] == pytest.approx(-0.1)


def test_labels_stand_where_their_items_are_turned_to() -> None:
    quarter = np.array([[0.0, 0, np.sqrt(0.5), np.sqrt(0.5)]])
    scene = furnished(
        [CUBE], [[3, 0, 0]], labels=[label("word", (0.0, -0.5, 0.0))], rotations=quarter
    )
    boxes = obstacles_of(scene)
    assert boxes.items.tolist() == [0, 0]
    assert boxes.is_label.tolist() == [False, True]
    assert len(boxes.bodies.items) == 1
    np.testing.assert_allclose(boxes.centers[:, 0], np.array([3.0, 3.5]), atol=1e-12)
    width, height, depth = label("word", (0.0, 0.0, 0.0)).size
    np.testing.assert_allclose(2 * boxes.halves[1], (width, height, depth))
    reach = np.abs(boxes.rotations[1]) @ boxes.halves[1] * 2
    np.testing.assert_allclose(reach, np.array([depth, width, height]))


def test_a_blank_text_is_no_obstacle() -> None:
    scene = furnished([Text(" ", 0.3, 0.1), Cone(1.0, 2.0)], [[0, 0, 0], [9, 0, 0]])
    assert set(obstacles_of(scene).items.tolist()) == {1}


def test_no_items_are_no_obstacles() -> None:
    assert len(obstacles_of(furnished([], np.zeros((0, 3)))).items) == 0
