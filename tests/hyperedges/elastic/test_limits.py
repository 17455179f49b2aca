from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.hyperedges.elastic.limits import MOST_UNLIKE, can_relax
from app.hyperedges.route import route
from app.solids.solid import Box
from tests.hyperedges.clearance.furniture import furnished

CUBE = Box((1.0, 1.0, 1.0), 0.05)


def test_what_is_usual_can_be_relaxed() -> None:
    assert can_relax(furnished([CUBE, CUBE], [[0, 0, 0], [50, 0, 0]], attachments=[[0, 1]]))
    assert can_relax(furnished([CUBE], [[0, 0, 0]]))


@pytest.mark.parametrize("routing", ["elastic", "auto"])
def test_what_is_too_large_goes_in_planes(routing: str) -> None:
    far = furnished([CUBE, CUBE], [[0, 0, 0], [1e6, 0, 0]], attachments=[[0, 1]] * 2, radius=0.01)
    unlike = replace(
        furnished([CUBE, CUBE], [[0, 0, 0], [9, 0, 0]], attachments=[[0, 1]] * 2),
        radii=np.array([1.0, 0.9 / MOST_UNLIKE]),
    )
    for scene in (far, unlike):
        assert not can_relax(scene)
        found = route(scene, routing="auto" if routing == "auto" else "elastic")
        planes = route(scene, routing="planes")
        np.testing.assert_array_equal(found.control_points, planes.control_points)
