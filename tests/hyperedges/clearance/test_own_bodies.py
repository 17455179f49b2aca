"""A hyperedge may touch its own items near its attachments, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.clearance.obstacles import obstacles_of
from app.hyperedges.clearance.own_bodies import LEAVING, beyond_own_balls, leaving_radii
from app.placement.placement import Placement
from app.solids.csg_tree import Leaf
from app.solids.solid import Box, Csg, Cylinder, Solid, Sphere, Tray
from tests.hyperedges.clearance.curves import CASES, points_at
from tests.hyperedges.clearance.furniture import furnished, routed
from tests.hyperedges.clearance.test_obstacle_gaps import beyond

RADIUS, CLEARANCE = 0.1, 0.05
BALL = LEAVING * (RADIUS + CLEARANCE)
SOLIDS: tuple[Solid, ...] = (
    Box((2.0, 1.0, 1.0), 0.05),
    Sphere(0.8),
    Cylinder(0.7, 1.5, 0.05),
    Tray((3.0, 2.0, 0.6), 0.2, 0.1),
)


def attached_at(solid: Solid, places: Floats, rotation: Floats | None = None) -> Placement:
    """One item at the origin, and a hyperedge that attaches to it at some places (a, 3)."""
    turns = None if rotation is None else rotation[None]
    scene = furnished(
        [solid], [[0, 0, 0]], rotations=turns, attachments=[[0] * len(places)], radius=RADIUS
    )
    return replace(scene, attachment_positions=places)


@pytest.mark.parametrize(
    ("place", "depth"), [((0, 0, 0.5), 0.0), ((0, 0, 0.3), 0.2), ((0, 0, 0), 0.5), ((0, 0, 9), 0.0)]
)
def test_the_ball_is_larger_by_the_depth_of_the_attachment(
    place: tuple[float, float, float], depth: float
) -> None:
    scene = attached_at(SOLIDS[0], np.array([place, place], dtype=np.float64))
    radii = leaving_radii(scene, obstacles_of(scene).bodies, CLEARANCE)
    np.testing.assert_allclose(radii, BALL + depth)


def test_from_the_middle_of_a_ball_every_way_leads_out() -> None:
    scene = attached_at(SOLIDS[1], np.zeros((2, 3)))
    radii = leaving_radii(scene, obstacles_of(scene).bodies, CLEARANCE)
    np.testing.assert_allclose(radii, BALL + 0.8)


def test_from_the_middle_of_what_may_be_hollow_it_is_the_way_out_along_the_direction() -> None:
    bowl = Csg(Leaf("sphere", (1.0,)), (2.0, 2.0, 2.0), (0.0, 0.0, 0.0), (0.0, 0.0, -0.8))
    scene = attached_at(bowl, np.array([[0, 0, -0.8], [0.9, 0, 0]], dtype=np.float64))
    radii = leaving_radii(scene, obstacles_of(scene).bodies, CLEARANCE)
    np.testing.assert_allclose(radii, [BALL + 1.8, BALL + 1.0])


coordinates = st.floats(-2.0, 2.0)
vectors = st.tuples(coordinates, coordinates, coordinates).map(np.array)
quaternions = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .map(np.array)
    .filter(lambda turn: np.linalg.norm(turn) > 0.1)
    .map(lambda turn: turn / np.linalg.norm(turn))
)


@settings(max_examples=max(CASES // 10, 100))
@given(
    st.lists(vectors, min_size=4, max_size=4).map(np.array),
    st.lists(vectors, min_size=2, max_size=3).map(np.array),
    st.floats(0.05, 1.5),
)
def test_pieces_cover_all_that_is_outside_the_balls(
    curve: Floats, centers: Floats, radius: float
) -> None:
    scene = attached_at(SOLIDS[0], centers)
    pieces, numbers = beyond_own_balls(
        curve[None], np.zeros((1, 2), dtype=np.int64), scene, np.full(len(centers), radius)
    )
    assert not numbers.any()
    sampled = points_at(curve, np.linspace(0, 1, 201))
    away = np.linalg.norm(sampled[:, None] - centers, axis=2).min(axis=1)
    covered = np.concatenate(
        [points_at(piece, np.linspace(0, 1, 33)) for piece in pieces] or [np.full((1, 3), np.inf)]
    )
    # A piece is at most the whole curve: its samples are so far apart.
    step = np.abs(np.diff(sampled, axis=0)).sum(axis=1).max() * 8 + 1e-9
    for place in sampled[away > radius + 1e-9]:
        assert np.linalg.norm(covered - place, axis=1).min() <= step
    # Nothing that is well inside is left.
    inside = np.linalg.norm(covered[:, None] - centers, axis=2).min(axis=1)
    longest = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
    assert (inside >= radius - longest / 64 - 1e-9).all() or not len(pieces)


@settings(max_examples=max(CASES // 10, 100))
@given(
    st.sampled_from(SOLIDS),
    quaternions,
    st.lists(vectors, min_size=4, max_size=4).map(np.array),
)
def test_the_certificate_is_sound_for_own_bodies(
    solid: Solid, rotation: Floats, curve: Floats
) -> None:
    scene = attached_at(solid, curve[[0, 3]], rotation)
    found = certify(routed([[curve]], radius=RADIUS), scene, CLEARANCE)
    bodies = obstacles_of(scene).bodies
    balls = leaving_radii(scene, bodies, CLEARANCE)
    sampled = points_at(curve, np.linspace(0, 1, 2001))
    away = np.linalg.norm(sampled[:, None] - curve[[0, 3]], axis=2)

    def nearest_outside(more: float) -> float:
        """The least distance of what is outside of the balls, or ``more`` deep in one."""
        outside = sampled[(away > balls - more).all(axis=1)]
        distances = [beyond(outside, bodies, k) for k in range(len(bodies.items))]
        return float(np.min(distances, initial=np.inf)) - RADIUS

    nearest = nearest_outside(0.0)
    if found.certified:
        assert nearest >= CLEARANCE - 1e-9
        assert nearest >= found.minimum - 1e-9
    else:
        assert found.conflicts.with_items.tolist() == [True]
        assert found.conflicts.lower[0] <= nearest + 1e-9
        # What is cut is a little larger than what is outside.
        longest = float(np.linalg.norm(np.diff(curve, axis=0), axis=1).sum())
        assert nearest_outside(longest / 64) <= CLEARANCE + longest / 64
