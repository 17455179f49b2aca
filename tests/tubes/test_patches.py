"""Patch pairs: the paper's control points, and ones that keep the tube's radius."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.tubes.patches import Rule, patch_pairs, patch_tubes
from app.tubes.sweep import sweep
from tests.tubes.routings import (
    RADIUS,
    nearest,
    places_on,
    random_routing,
    routing_of,
    segments,
    smallest_bend,
)
from tests.tubes.surfaces import boundary_edges, facet_normals

TOLERANCE = 0.02 * RADIUS
STRAIGHT = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
ARCH = [[0, 0, 0], [0, 0, 2], [3, 0, 2], [3, 0, 0]]

rules = pytest.mark.parametrize("rule", get_args(Rule))
few_numbers = st.sampled_from([0.0, 1.0, -1.0, 1e-13, 3.5])
any_point = st.tuples(few_numbers, few_numbers, few_numbers)


def surface(pairs: Floats, along: int, across: int) -> Floats:
    """Points of both patches, (s, 2, along, across, 3)."""
    return places_on(np.moveaxis(places_on(np.moveaxis(pairs, 3, 2), along), 3, 2), across)


def radius_errors(routing: Routing, rule: Rule) -> Floats:
    """Of each segment, the largest error of the radius as a share of it."""
    places = surface(patch_pairs(routing, rule), 25, 9)
    errors = []
    for k, control_points in enumerate(routing.control_points):
        cloud = places[k, :, 1:-1].reshape(-1, 3)
        distances = np.linalg.norm(cloud - nearest(cloud, control_points[None]), axis=1)
        errors.append(np.abs(distances / RADIUS - 1).max())
    return np.array(errors)


@rules
def test_a_straight_segment_has_the_control_points_of_the_paper(rule: Rule) -> None:
    pair = patch_pairs(segments(STRAIGHT), rule)[0]
    offset = pair[0, 0, 3] - pair[0, 0, 0]
    np.testing.assert_allclose(np.linalg.norm(offset), 2 * RADIUS)
    np.testing.assert_allclose(offset[0], 0, atol=1e-15)
    up = np.cross(offset / 2, [1, 0, 0]) * 4 / 3
    for row in range(4):
        place = np.array([row, 0, 0])
        expected = [-offset / 2, -offset / 2 + up, offset / 2 + up, offset / 2]
        np.testing.assert_allclose(pair[0, row], place + expected, atol=1e-15)
        np.testing.assert_allclose(pair[1, row, [0, 3]], pair[0, row, [0, 3]], atol=1e-15)
        np.testing.assert_allclose(pair[1, row, 1:3], pair[0, row, 1:3] - 2 * up, atol=1e-15)


def test_by_the_papers_rule_the_top_of_a_level_segment_is_above_its_bottom() -> None:
    pair = patch_pairs(segments(STRAIGHT), "paper")[0]
    r = RADIUS
    np.testing.assert_allclose(
        pair[0, 0], [[0, r, 0], [0, r, r * 4 / 3], [0, -r, r * 4 / 3], [0, -r, 0]], atol=1e-15
    )


def test_by_the_papers_rule_offsets_are_perpendicular_outside_and_halfway_inside() -> None:
    pair = patch_pairs(segments(ARCH), "paper")[0]
    offsets = (pair[0, :, 3] - pair[0, :, 0]) / (2 * RADIUS)
    half = np.sqrt(0.5)
    expected = np.array([[1, 0, 0], [half, 0, -half], [-half, 0, -half], [-1, 0, 0]])
    np.testing.assert_allclose(offsets * np.sign(offsets[0, 0]), expected, atol=1e-12)


def test_by_the_papers_rule_an_s_curve_keeps_its_sides() -> None:
    pair = patch_pairs(segments([[0, 0, 0], [2, 0, 0], [1, 2, 0], [3, 2, 0]]), "paper")[0]
    left = surface(pair[None], 30, 3)[0, 0, :, 0]
    axis = places_on(np.array([[0, 0, 0], [2, 0, 0], [1, 2, 0], [3, 2, 0]]), 30)
    side = np.cross(np.gradient(axis, axis=0), left - axis)[:, 2]
    assert (side > 0).all() or (side < 0).all()


@rules
def test_the_section_of_a_tube_is_nearly_round(rule: Rule) -> None:
    places = surface(patch_pairs(segments(STRAIGHT), rule), 5, 1001)
    radii = np.linalg.norm(places[..., 1:], axis=-1) / RADIUS
    assert radii.min() == pytest.approx(1.0, abs=1e-12)
    assert radii.max() == pytest.approx(1.018, abs=5e-4)


def test_fitted_patches_keep_the_radius_where_the_papers_are_pinched() -> None:
    routing = random_routing(seed=7, hyperedges=25)
    ordinary = smallest_bend(routing.control_points) > 2 * RADIUS
    paper = np.median(radius_errors(routing, "paper")[ordinary])
    fitted = np.median(radius_errors(routing, "fitted")[ordinary])
    assert 0.1 < paper < 0.4
    assert fitted < 0.05


def test_fitted_patches_meet_in_one_rim_at_a_join() -> None:
    for attachments in (3, 4, 5):
        routing = random_routing(seed=8, hyperedges=3, attachments=attachments)
        rims = surface(patch_pairs(routing, "fitted"), 2, 9)
        for k in range(3):
            joins = np.arange(*routing.join_starts[k : k + 2])
            for number, join in enumerate(joins):
                first = routing.segment_starts[k]
                own = routing.segment_ends[first : routing.segment_starts[k + 1]]
                at = np.argwhere(own == attachments + number)
                clouds = [rims[first + s, :, e].reshape(-1, 3) for s, e in at]
                for cloud in clouds[1:]:
                    apart = np.linalg.norm(cloud[:, None] - clouds[0], axis=2)
                    assert apart.min(axis=1).max() < 1e-9
                middle = clouds[0].reshape(2, 9, 3)[:, [0, -1]].mean(axis=(0, 1))
                np.testing.assert_allclose(middle, routing.join_positions[join], atol=1e-12)


@rules
def test_the_mesh_lies_on_the_patches_and_is_closed(rule: Rule) -> None:
    routing = routing_of([np.array([[0.0, 0, 0], [6, 0, 0], [3, 6, 0]])])
    mesh = patch_tubes(routing, rule, TOLERANCE).mesh(0)
    swept = sweep(routing, TOLERANCE).mesh(0)
    assert boundary_edges(mesh) == 0
    assert len(mesh.vertices) == len(swept.vertices) + 3
    dense = surface(patch_pairs(routing, rule), 200, 33).reshape(-1, 3)
    from scipy.spatial import cKDTree

    gaps, _ = cKDTree(dense).query(mesh.vertices)
    beyond = np.min(
        [
            np.linalg.norm(mesh.vertices - end, axis=1)
            for end in routing.control_points[:, [0, 3]].reshape(-1, 3)
        ],
        axis=0,
    )
    assert gaps[beyond > 1.1 * RADIUS].max() < 0.2 * RADIUS


@rules
def test_faces_and_normals_look_outwards(rule: Rule) -> None:
    for curve in (STRAIGHT, [[0, 0, 0], [0, 0, 2], [2, 1, 3], [5, 1, 3]]):
        mesh = patch_tubes(segments(curve), rule, TOLERANCE).mesh(0)
        flat, solid = facet_normals(mesh)
        smooth = mesh.normals[mesh.faces[solid]]
        assert (np.einsum("fx,fkx->fk", flat, smooth) > 0.8).all()


@rules
def test_a_straight_patch_tube_has_the_ends_and_normals_of_a_swept_one(rule: Rule) -> None:
    mesh = patch_tubes(segments(STRAIGHT), rule, TOLERANCE).mesh(0)
    assert mesh.bounds[:, 0].tolist() == pytest.approx([-RADIUS, 3 + RADIUS])
    middle = (mesh.vertices[:, 0] >= 0) & (mesh.vertices[:, 0] <= 3)
    away = mesh.vertices[middle] * [0, 1, 1]
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    # The section leans up to 3 degrees from a circle's.
    assert (np.einsum("vx,vx->v", away, mesh.normals[middle]) > 0.995).all()


@rules
@settings(max_examples=40)
@given(points=st.lists(any_point, min_size=2, max_size=5))
def test_whatever_the_attachments_there_are_finite_patches_and_unit_normals(
    rule: Rule, points: list[tuple[float, float, float]]
) -> None:
    with np.errstate(invalid="ignore"):
        routing = routing_of([np.array(points)])
    routing.join_tangents[~np.isfinite(routing.join_tangents)] = 0.0
    assert np.isfinite(patch_pairs(routing, rule)).all()
    tubes = patch_tubes(routing, rule, TOLERANCE)
    assert np.isfinite(tubes.vertices).all()
    np.testing.assert_allclose(np.linalg.norm(tubes.normals, axis=1), 1.0, atol=1e-5)


@rules
def test_any_four_control_points_have_rows_as_long_as_the_rule_says(rule: Rule) -> None:
    curves = np.random.default_rng(3).uniform(-2, 2, (50, 4, 3))
    pairs = patch_pairs(segments(*curves.tolist()), rule)
    rows = range(4) if rule == "paper" else (0, 3)
    for row in rows:
        offset = (pairs[:, 0, row, 3] - pairs[:, 0, row, 0]) / 2
        up = pairs[:, 0, row, 1] - pairs[:, 0, row, 0]
        np.testing.assert_allclose(np.linalg.norm(offset, axis=1), RADIUS)
        np.testing.assert_allclose(np.linalg.norm(up, axis=1), RADIUS * 4 / 3)
        np.testing.assert_allclose(np.einsum("sx,sx->s", offset, up), 0, atol=1e-12)
    middles = pairs.mean(axis=(1, 3))
    np.testing.assert_allclose(middles, curves, atol=1e-12)


@rules
def test_no_hyperedges_give_no_patches(rule: Rule) -> None:
    assert patch_pairs(segments(), rule).shape == (0, 2, 4, 4, 3)
    assert patch_tubes(segments(), rule, TOLERANCE).faces.shape == (0, 3)
