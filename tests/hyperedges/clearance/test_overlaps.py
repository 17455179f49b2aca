from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.obstacles import obstacles_of
from app.hyperedges.clearance.overlaps import MOST, find_overlaps
from app.placement.placement import Placement
from app.solids.solid import Box, Solid, Sphere, Tray
from tests.hyperedges.clearance.furniture import furnished, label
from tests.hyperedges.clearance.test_obstacle_gaps import beyond
from tests.hyperedges.clearance.test_own_bodies import quaternions, vectors

CUBE = Box((1.0, 1.0, 1.0), 0.05)
SOLIDS: tuple[Solid, ...] = (CUBE, Box((0.4, 2.0, 1.0), 0.1), Sphere(0.7))


def overlapping(placement: Placement) -> list[list[int]]:
    found: list[list[int]] = find_overlaps(placement).items.tolist()
    return found


def test_items_that_stand_in_each_other_are_found_with_their_depth() -> None:
    scene = furnished([CUBE, Sphere(0.5), CUBE], [[0, 0, 0], [0.9, 0, 0], [0, 5, 0]])
    found = find_overlaps(scene)
    assert found.items.tolist() == [[0, 1]]
    assert found.depths[0] == pytest.approx(0.1)


def test_what_stands_on_another_or_beside_it_does_not_overlap() -> None:
    scene = furnished([CUBE] * 3, [[0, 0, 0.5], [0, 0, 1.5], [1.0, 0, 0.5]])
    assert overlapping(scene) == []


def test_what_contains_another_does_not_overlap_it() -> None:
    scene = furnished([Box((9.0, 9.0, 9.0), 0.1), CUBE, Sphere(0.2)], np.zeros((3, 3)))
    assert overlapping(scene) == [[0, 1], [0, 2], [1, 2]]
    assert overlapping(replace(scene, parents=np.array([-1, 0, 1]))) == []
    assert overlapping(replace(scene, parents=np.array([-1, 0, 0]))) == [[1, 2]]


def test_what_lies_in_a_tray_overlaps_neither_it_nor_its_label() -> None:
    tray = Tray((5.0, 5.0, 1.0), 0.2, 0.2)
    written = [label("on the floor", (0.0, 0.0, -0.3)), None]
    scene = furnished([tray, CUBE], [[0, 0, 0.5], [0, 0, 0.7]], labels=written)
    assert overlapping(scene) == []
    through_the_wall = furnished([tray, CUBE], [[0, 0, 0.5], [2.4, 0, 0.7]])
    assert overlapping(through_the_wall) == [[0, 1]]


def test_a_heap_of_items_is_not_listed_whole() -> None:
    heap = furnished([CUBE] * 2000, np.zeros((2000, 3)))
    assert len(find_overlaps(heap).items) == MOST


@settings(max_examples=200)
@given(st.lists(st.sampled_from(SOLIDS), min_size=2, max_size=2), vectors, quaternions)
def test_boxes_overlap_where_they_share_points(
    solids: list[Solid], away: Floats, rotation: Floats
) -> None:
    turns = np.stack([[0.0, 0, 0, 1], rotation])
    scene = furnished(solids, [[0, 0, 0], away.tolist()], rotations=turns)
    bodies, found = obstacles_of(scene), find_overlaps(scene)
    steps = np.linspace(-1, 1, 21)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    radius, halves = float(bodies.roundings[1]), bodies.halves[1]
    if radius:
        grid = radius * grid / np.maximum(np.linalg.norm(grid, axis=1, keepdims=True), 1.0)
    else:
        grid = grid * halves
    places = bodies.centers[1] + grid @ bodies.rotations[1].T
    nearest = float(beyond(places, bodies, 0).min())
    if nearest < -1e-6:
        assert found.items.tolist() == [[0, 1]]
    if len(found.items):
        # They share a point, and of each point there is one of the grid so near.
        assert nearest <= np.linalg.norm(np.maximum(halves, radius)) / 20
