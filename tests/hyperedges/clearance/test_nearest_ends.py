from __future__ import annotations

import numpy as np

from app.hyperedges.clearance.nearest_ends import nearest_ends
from app.solids.solid import Box
from tests.hyperedges.clearance.furniture import furnished

CUBE = Box((1.0, 1.0, 1.0), 0.05)


def test_the_nearest_attachment_of_each_is_found() -> None:
    places = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 6.0, 0.0]]
    scene = furnished([CUBE] * 3, places, attachments=[[0, 1], [2, 1, 0]])
    asked = np.array([[3.0, 0.0, 0.5], [0.0, 5.0, 0.5], [0.0, 1.0, 0.5]])
    rows, far = nearest_ends(scene, np.array([0, 1, 1]), asked)
    assert rows.tolist() == [1, 2, 4]
    np.testing.assert_allclose(far, [1.0, 1.0, 1.0])


def test_nothing_is_asked() -> None:
    rows, far = nearest_ends(
        furnished([CUBE], [[0.0, 0.0, 0.0]]), np.zeros(0, int), np.zeros((0, 3))
    )
    assert len(rows) == len(far) == 0
