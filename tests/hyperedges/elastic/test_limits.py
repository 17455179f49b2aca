from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.elastic import neighbours, run
from app.hyperedges.elastic.beads import Beads
from app.hyperedges.elastic.limits import WIDEST, can_relax
from app.hyperedges.elastic.relaxation import Near
from app.hyperedges.route import route
from app.solids.solid import Box
from tests.hyperedges.clearance.furniture import furnished

CUBE = Box((1.0, 1.0, 1.0), 0.05)


CLEARANCE = 0.05


def test_what_is_usual_can_be_relaxed() -> None:
    usual = furnished([CUBE, CUBE], [[0, 0, 0], [50, 0, 0]], attachments=[[0, 1]])
    assert can_relax(usual, CLEARANCE)
    assert can_relax(furnished([CUBE], [[0, 0, 0]]), CLEARANCE)


@pytest.mark.parametrize("routing", ["elastic", "auto"])
def test_what_is_too_large_goes_in_planes(routing: Literal["elastic", "auto"]) -> None:
    for far, clearance in ((1e6, CLEARANCE), (9.0, 1.01 * WIDEST * 0.01)):
        places = [[0.0, 0.0, 0.0], [far, 0.0, 0.0]]
        scene = furnished([CUBE, CUBE], places, attachments=[[0, 1]] * 2, radius=0.01)
        assert not can_relax(scene, clearance)
        found = route(scene, clearance=clearance, routing=routing)
        planes = route(scene, clearance=clearance, routing="planes")
        np.testing.assert_array_equal(found.control_points, planes.control_points)


def test_a_thick_tube_far_off_gives_thin_ones_no_more_neighbours(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    watched: list[int] = []

    def find_near(x: Floats, beads: Beads, *rest: Any) -> Near:
        near = neighbours.find_near(x, beads, *rest)
        watched.append(int((beads.owners[near.pairs] < 2).all(axis=1).sum()))
        return near

    monkeypatch.setattr(run, "find_near", find_near)
    places = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 90.0, 0.0], [9.0, 90.0, 0.0]]
    scene = furnished([CUBE] * 4, places, attachments=[[0, 1], [0, 1], [2, 3]])
    first = []
    for thick in (0.02, 0.4):
        watched.clear()
        unlike = replace(scene, radii=np.array([0.02, 0.02, thick]))
        route(unlike, clearance=CLEARANCE, routing="elastic")
        first.append(watched[0])
    assert first[0] == first[1] > 0


@pytest.mark.parametrize("routing", ["elastic", "auto"])
def test_what_is_too_dense_goes_in_planes(
    routing: Literal["elastic", "auto"], monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = furnished([CUBE, CUBE], [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0]], attachments=[[0, 1]] * 4)
    planes = route(scene, routing="planes")
    found = route(scene, routing="elastic")
    assert not np.array_equal(found.control_points, planes.control_points)
    monkeypatch.setattr(neighbours, "MOST_NEAR", 4)
    found = route(scene, routing=routing)
    np.testing.assert_array_equal(found.control_points, planes.control_points)
