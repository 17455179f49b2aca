"""Swept tubes are round, closed, smooth, and meet at joins."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Indices
from app.hyperedges.routing import Routing
from app.tubes.sweep import sweep
from app.tubes.tubes import Tubes
from tests.tubes.routings import (
    RADIUS,
    nearest,
    places_on,
    random_routing,
    routing_of,
    segments,
    smallest_bend,
)
from tests.tubes.surfaces import boundary_edges, facet_normals, facet_samples

TOLERANCE = 0.02 * RADIUS
BEND = [[0, 0, 0], [0, 0, 2], [2, 0, 3], [4, 0, 3]]
STRAIGHT = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]

few_numbers = st.sampled_from([0.0, 1.0, -1.0, 1e-13, 1e6, 3.5])
any_point = st.tuples(few_numbers, few_numbers, few_numbers)
any_curve = st.lists(any_point, min_size=4, max_size=4)


def gentle_hyperedges(routing: Routing) -> Indices:
    """Those that bend nowhere more tightly than a tube of twice their radius could."""
    bends = smallest_bend(routing.control_points)
    return np.flatnonzero(np.minimum.reduceat(bends, routing.segment_starts[:-1]) > 2 * RADIUS)


def worst_error(routing: Routing, tubes: Tubes) -> float:
    """How far the facets of single segments are from the true tubes, at most."""
    errors = []
    for k in range(len(routing.radii)):
        samples = facet_samples(tubes.mesh(k))
        axis = nearest(samples, routing.control_points[k : k + 1])
        errors.append(np.abs(np.linalg.norm(samples - axis, axis=1) - routing.radii[k]).max())
    return float(max(errors))


@pytest.mark.parametrize("attachments", [2, 3, 4])
def test_every_vertex_is_a_radius_from_the_curve_and_its_normal_points_away(
    attachments: int,
) -> None:
    routing = random_routing(seed=5, hyperedges=30, attachments=attachments)
    tubes = sweep(routing, TOLERANCE)
    chosen = gentle_hyperedges(routing)
    assert len(chosen) >= 5
    for k in chosen:
        mesh = tubes.mesh(k)
        axis = nearest(
            mesh.vertices.astype(np.float64),
            routing.control_points[slice(*routing.segment_starts[k : k + 2])],
        )
        away = mesh.vertices - axis
        distances = np.linalg.norm(away, axis=1)
        # Near a join, a vertex of one tube may lie inside another, nearer to that other's axis.
        own = distances > RADIUS * (1 - 1e-4)
        assert own.mean() > (0.7 if attachments > 2 else 1 - 1e-9)
        np.testing.assert_allclose(distances[own], RADIUS, rtol=1e-4)
        outward = np.abs(mesh.normals[own] - away[own] / RADIUS).max(axis=1) < 2e-3
        assert outward.mean() > (0.99 if attachments > 2 else 1 - 1e-9)


def test_faces_look_outwards() -> None:
    for curve in (BEND, STRAIGHT):
        mesh = sweep(segments(curve), TOLERANCE).mesh(0)
        flat, solid = facet_normals(mesh)
        smooth = mesh.normals[mesh.faces[solid]]
        assert (np.einsum("fx,fkx->fk", flat, smooth) > 0.8).all()


@pytest.mark.parametrize("attachments", [2, 3, 4, 6])
def test_a_hyperedge_has_no_open_edge(attachments: int) -> None:
    routing = random_routing(seed=1, hyperedges=5, attachments=attachments)
    tubes = sweep(routing, TOLERANCE)
    for k in range(5):
        assert boundary_edges(tubes.mesh(k)) == 0


@pytest.mark.parametrize("attachments", [3, 4, 5, 7])
def test_three_tubes_share_the_rim_of_their_join_to_the_bit(attachments: int) -> None:
    routing = random_routing(seed=2, hyperedges=6, attachments=attachments)
    tubes = sweep(routing, TOLERANCE)
    for k in range(6):
        mesh = tubes.mesh(k)
        for j in range(*routing.join_starts[k : k + 2]):
            away = mesh.vertices - routing.join_positions[j]
            on_rim = (np.abs(np.linalg.norm(away, axis=1) - RADIUS) < 1e-5) & (
                np.abs(away @ routing.join_tangents[j]) < 1e-5
            )
            rim = np.concatenate([mesh.vertices[on_rim], mesh.normals[on_rim]], axis=1)
            distinct, counts = np.unique(rim, axis=0, return_counts=True)
            assert len(distinct) == 16
            assert (counts == 3).all()


def test_ends_at_attachments_are_round() -> None:
    mesh = sweep(segments(STRAIGHT), TOLERANCE).mesh(0)
    np.testing.assert_allclose(
        mesh.bounds, [[-RADIUS, -RADIUS, -RADIUS], [3 + RADIUS, RADIUS, RADIUS]], atol=1e-7
    )
    beyond = mesh.vertices[mesh.vertices[:, 0] > 3] - [3, 0, 0]
    np.testing.assert_allclose(np.linalg.norm(beyond, axis=1), RADIUS, rtol=1e-6)
    assert len(beyond) == 3 * 16 + 1


def test_a_straight_segment_needs_no_rings_between_its_ends_and_a_bent_one_does() -> None:
    sides, cap = 16, 3 * 16 + 1
    straight = sweep(segments(STRAIGHT), TOLERANCE)
    bent = sweep(segments(BEND), TOLERANCE)
    assert len(straight.vertices) == 2 * sides + 2 * cap
    assert len(bent.vertices) > 10 * sides + 2 * cap


def test_rings_gather_where_the_curve_turns() -> None:
    hairpin: list[list[float]] = [[0, 0, 0], [4, 0, 0.2], [4, 0, 0.3], [0, 0, 0.5]]
    x = sweep(segments(hairpin), TOLERANCE).vertices[:, 0]
    assert np.count_nonzero(x > 2.7) > 2 * np.count_nonzero((x > 0.5) & (x < 2.5))


def test_a_turn_in_a_small_part_of_the_parameter_is_not_missed() -> None:
    routing = segments([[0, 0, 0], [40, 0, 2], [40, 0, 4], [0, 0, 6]])
    assert RADIUS < smallest_bend(routing.control_points)[0] < 2 * RADIUS
    assert worst_error(routing, sweep(routing, TOLERANCE)) < 2.3 * TOLERANCE


@pytest.mark.parametrize("seed", range(2))
def test_facets_keep_to_the_tolerance_and_a_finer_one_is_never_worse(seed: int) -> None:
    routing = random_routing(seed, hyperedges=6, attachments=2)
    before = np.inf
    for tolerance in 0.2 * RADIUS * 0.5 ** np.arange(7):
        error = worst_error(routing, sweep(routing, tolerance))
        # Around and along the tube each may take the whole tolerance, a twist a quarter more.
        assert error < 2.3 * tolerance + 1e-6
        assert error <= before
        before = error


@settings(max_examples=60)
@given(st.lists(any_curve, min_size=1, max_size=3))
def test_whatever_the_control_points_there_is_a_tube_with_unit_normals(
    curves: list[list[tuple[float, float, float]]],
) -> None:
    routing = segments(*curves)
    tubes = sweep(routing, TOLERANCE)
    assert np.isfinite(tubes.vertices).all()
    np.testing.assert_allclose(np.linalg.norm(tubes.normals, axis=1), 1.0, atol=1e-5)
    for k in range(len(curves)):
        assert boundary_edges(tubes.mesh(k)) == 0 or np.abs(routing.control_points[k]).max() > 10


@settings(max_examples=60)
@given(st.lists(any_point, min_size=3, max_size=6), any_point)
def test_whatever_the_join_there_is_a_tube_with_unit_normals(
    points: list[tuple[float, float, float]], tangent: tuple[float, float, float]
) -> None:
    with np.errstate(invalid="ignore"):
        routing = routing_of([np.array(points)])
    length = np.linalg.norm(tangent)
    routing.join_tangents[:] = np.array(tangent) / length if length > 0 else [0, 0, 1]
    tubes = sweep(routing, TOLERANCE)
    assert np.isfinite(tubes.vertices).all()
    np.testing.assert_allclose(np.linalg.norm(tubes.normals, axis=1), 1.0, atol=1e-5)


def test_a_segment_of_no_length_is_a_ball() -> None:
    mesh = sweep(segments([[1, 2, 3]] * 4), TOLERANCE).mesh(0)
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices - [1, 2, 3], axis=1), RADIUS, rtol=1e-5)
    assert boundary_edges(mesh) == 0


def test_the_same_routing_gives_the_same_bytes() -> None:
    routing = random_routing(seed=3, hyperedges=20)
    first, second = sweep(routing, TOLERANCE), sweep(routing, TOLERANCE)
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.normals.tobytes() == second.normals.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()


def test_a_hyperedge_looks_the_same_whoever_its_neighbours_are() -> None:
    generator = np.random.default_rng(4)
    points = [generator.uniform(0, 5, (n, 3)) for n in (2, 3, 4, 5)]
    together = sweep(routing_of(points), TOLERANCE)
    for k in range(4):
        alone = sweep(routing_of([points[k]]), TOLERANCE).mesh(0)
        mesh = together.mesh(k)
        np.testing.assert_array_equal(mesh.vertices, alone.vertices)
        np.testing.assert_array_equal(mesh.normals, alone.normals)
        np.testing.assert_array_equal(mesh.faces, alone.faces)


def test_equal_counts_of_rings_and_sides_give_equal_faces() -> None:
    bend = np.array(BEND, dtype=float)
    mirrored = bend * [-1, 1, 1] + [0, 7, 0]
    tubes = sweep(segments(bend.tolist(), mirrored.tolist()), TOLERANCE)
    np.testing.assert_array_equal(tubes.mesh(0).faces, tubes.mesh(1).faces)


def test_faces_number_the_vertices_of_their_own_hyperedge() -> None:
    tubes = sweep(random_routing(seed=6, hyperedges=7, attachments=4), TOLERANCE)
    for k in range(7):
        mesh = tubes.mesh(k)
        assert np.array_equal(np.unique(mesh.faces), np.arange(len(mesh.vertices)))


def test_radii_differ_by_hyperedge_and_sides_with_them() -> None:
    routing = segments(BEND, BEND)
    routing.radii[1] = 4 * RADIUS
    tubes = sweep(routing, TOLERANCE)
    straight = places_on(routing.control_points[1], 5)[0]
    assert np.abs(tubes.mesh(1).vertices[:, 1] - straight[1]).max() == pytest.approx(4 * RADIUS)
    assert len(tubes.mesh(1).vertices) > len(tubes.mesh(0).vertices)


def test_no_hyperedges_give_no_triangles() -> None:
    tubes = sweep(segments(), TOLERANCE)
    assert tubes.vertices.shape == tubes.normals.shape == tubes.faces.shape == (0, 3)


@pytest.mark.parametrize("tolerance", [0.0, -1.0, float("nan")])
def test_a_tolerance_must_be_positive(tolerance: float) -> None:
    with pytest.raises(ValueError, match="positive"):
        sweep(segments(BEND), tolerance)
