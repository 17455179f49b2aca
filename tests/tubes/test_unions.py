from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.errors import Unprintable
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.solids.mesh import Mesh
from app.tubes.tubes import Tubes
from app.tubes.unions import plan_unions, unite
from tests.hyperedges.scenes import placement, troubles
from tests.tubes.routings import RADIUS, nearest, places_on, random_routing, routing_of, segments
from tests.tubes.surfaces import facet_samples

SHARE = 0.02
"""Tolerance, as a share of the radius."""

Curves = Literal["steiner", "prose", "symbolic"]


def united(routing: Routing) -> Tubes:
    names = [f"e{number}" for number in range(len(routing.radii))]
    return unite(plan_unions(routing, SHARE * routing.radii), names)


def assert_one_body(mesh: Mesh) -> None:
    """Closed, all facing outward, in one piece; as a reader of a file without topology sees it."""
    body = trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)
    assert len(body.faces) == len(mesh.faces)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume > 0
    assert body.body_count == 1


def windings(mesh: Mesh, places: Floats) -> Floats:
    """How often the surface goes around each place (p,): van Oosterom and Strackee (1983)."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    found = np.empty(len(places))
    for number, place in enumerate(places):
        a, b, c = np.moveaxis(corners - place, 1, 0)
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        triple = np.einsum("fx,fx->f", a, np.cross(b, c))
        below = la * lb * lc + np.einsum("fx,fx->f", a, b) * lc
        below += np.einsum("fx,fx->f", b, c) * la + np.einsum("fx,fx->f", c, a) * lb
        found[number] = np.arctan2(triple, below).sum() / (2 * np.pi)
    return found


def assert_what_a_ball_fills(mesh: Mesh, routing: Routing) -> None:
    radius = float(routing.radii[0])
    chance = np.random.default_rng(2)
    aside = chance.normal(size=(60, 3))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    curve = places_on(routing.control_points, 41).reshape(-1, 3)
    inside = curve[chance.integers(0, len(curve), 60)] + 0.9 * radius * aside
    np.testing.assert_allclose(windings(mesh, inside), 1.0, atol=1e-3)

    places = facet_samples(mesh)
    apart = np.linalg.norm(places - nearest(places, routing.control_points), axis=1) / radius
    assert apart.max() < 1 + SHARE + 0.005
    assert apart.min() > 1 - 2 * SHARE - 0.005


@st.composite
def hyperedges(draw: st.DrawFn) -> Routing:
    """Curves of all kinds between 2 to 8 places, near each other or far; thin tubes and thick."""
    count = draw(st.integers(2, 8))
    seed, spread = draw(st.integers(0, 2**32 - 1)), draw(st.sampled_from([0.1, 1.0, 3.0, 9.0]))
    points = np.random.default_rng(seed).uniform(0, spread, (count, 3)) * [1, 1, 0.2]
    if draw(st.booleans()):
        points = np.round(points)
    curves: Curves = draw(st.sampled_from(["steiner", "prose", "symbolic"]))
    fidelity: Literal["best", "paper"] = draw(st.sampled_from(["best", "paper"]))
    radius = draw(st.sampled_from([0.05, 0.1, 0.3]))
    scene = placement(points, [0, count], radius=radius)
    return route(scene, curves=curves, fidelity=fidelity, clearance=None)


@settings(max_examples=40)
@given(hyperedges())
def test_any_hyperedge_is_one_body(routing: Routing) -> None:
    assert_one_body(united(routing).mesh(0))


@pytest.mark.parametrize("seed", range(3))
def test_a_body_is_what_a_ball_fills(seed: int) -> None:
    routing = random_routing(seed, 1, 4)
    assert_what_a_ball_fills(united(routing).mesh(0), routing)


HAIRPIN = [[0, 0, 0], [2, 0, 0], [2, 0.05, 0], [0, 0.05, 0]]
CUSP = [[0, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0]]
LOOP = [[0, 0, 0], [4, 2, 0.02], [-3, 2, 0.05], [1, 0, 0.07]]
POINT = [[1, 2, 3]] * 4
SPECK = [[1, 2, 3], [1 + 1e-7, 2, 3], [1, 2 + 1e-7, 3], [1 + 1e-7, 2, 3 + 1e-7]]
STRAIGHT = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
THERE_AND_BACK = [[0, 0, 0], [2, 0, 0], [2, 0, 0], [0, 0, 0]]


@pytest.mark.parametrize(
    "curve", [HAIRPIN, CUSP, LOOP, POINT, SPECK, STRAIGHT, THERE_AND_BACK], ids=str
)
def test_curves_that_tubes_cannot_follow_make_bodies_too(curve: Sequence[Sequence[float]]) -> None:
    routing = segments(curve)
    mesh = united(routing).mesh(0)
    assert_one_body(mesh)
    if curve not in (POINT, SPECK):
        assert_what_a_ball_fills(mesh, routing)


@pytest.mark.parametrize("name", [
    "all at one place", "few places", "two places", "line", "vertical line", "in the join plane",
    "ring", "tiny", "vanishing", "signed zeros",
])  # fmt: skip
@pytest.mark.parametrize("curves", ["steiner", "symbolic"])
def test_places_that_are_trouble_make_bodies_too(name: str, curves: Curves) -> None:
    scene = placement(troubles(4)[name], [0, 4])
    assert_one_body(united(route(scene, curves=curves, fidelity="best", clearance=None)).mesh(0))


def test_a_point_is_a_ball() -> None:
    mesh = united(segments(POINT)).mesh(0)
    ball = 4 / 3 * np.pi * RADIUS**3
    assert 0.9 * ball < trimesh.Trimesh(mesh.vertices, mesh.faces).volume < ball


def test_a_hyperedge_that_goes_around_something_is_one_body() -> None:
    """Two segments that meet at a bend, which is no end."""
    whole = np.array([[0, 0, 0], [0, 0, 2], [4, 0, 2], [4, 0, 0]], dtype=float)
    left = [whole[0], whole[:2].mean(axis=0), [1.0, 0, 1.5], [2.0, 0, 1.5]]
    right = [[2.0, 0, 1.5], [3.0, 0, 1.5], whole[2:].mean(axis=0), whole[3]]
    routing = Routing(
        control_points=np.array([left, right]),
        segment_starts=np.array([0, 2]),
        segment_ends=np.array([[0, 2], [2, 1]]),
        join_positions=np.array([[2.0, 0, 1.5]]),
        join_tangents=np.array([[1.0, 0, 0]]),
        join_starts=np.array([0, 1]),
        join_planes=np.zeros(1),
        radii=np.array([RADIUS]),
    )
    mesh = united(routing).mesh(0)
    assert_one_body(mesh)
    assert_what_a_ball_fills(mesh, routing)


def test_each_hyperedge_is_where_it_belongs() -> None:
    routing = random_routing(5, 4, 3)
    tubes = united(routing)
    for number in range(4):
        mesh = tubes.mesh(number)
        assert_one_body(mesh)
        own = routing.control_points[routing.segment_starts[number] :][:3]
        vertices = mesh.vertices.astype(np.float64)
        apart = np.linalg.norm(vertices - nearest(vertices, own), axis=1)
        assert apart.max() < 1.01 * RADIUS
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)


def test_the_same_routing_gives_the_same_bytes() -> None:
    one, other = united(random_routing(3, 2, 5)), united(random_routing(3, 2, 5))
    assert one.vertices.tobytes() == other.vertices.tobytes()
    assert one.faces.tobytes() == other.faces.tobytes()


def test_progress_grows() -> None:
    told: list[float] = []
    routing = random_routing(1, 5, 2)
    unite(plan_unions(routing, 0.01), list("abcde"), told.append)
    assert told == sorted(told)
    assert 0 <= told[0] < told[-1] < 1


def test_every_tube_too_thin_for_its_scene_is_named() -> None:
    near = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.0]])
    routing = routing_of([near, near + 1e6])
    with pytest.raises(Unprintable, match=r"'thin' cannot be printed.*0\.1 is too small") as caught:
        unite(plan_unions(routing, 0.01), ["thin", "far"])
    assert [fault.pointer for fault in caught.value.faults] == ["/hyperedges/0", "/hyperedges/1"]


def test_what_goes_in_is_counted_before() -> None:
    routing = random_routing(1, 3, 2)
    plan = plan_unions(routing, 0.002)
    assert len(unite(plan, list("abc")).faces) <= plan.triangles <= 3 * 1500


def test_nothing_makes_nothing() -> None:
    tubes = unite(plan_unions(routing_of([np.eye(3)]), 0.01), ["e"])
    assert len(tubes.vertex_starts) == 2
    assert len(Tubes.of([]).vertices) == 0
