from __future__ import annotations

from math import pi

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from app.errors import DocumentTooLarge, InconsistentDocument
from app.solids.csg import Body, make_body
from app.solids.csg_tree import Leaf, Operation, Tree
from tests.cost import check_costs_less, check_growth
from tests.solids.csg_trees import clear_of_surfaces, contains, trees
from tests.solids.surfaces import assert_closed, assert_sound, encloses, largest_deviation, welded

BLOCK = Leaf("box", (2.0, 2.0, 2.0))
BALL = Leaf("sphere", (1.3,))
ROD = Leaf("cylinder", (0.5, 3.0))
QUARTER = 0.5**0.5


def union(*of: Tree) -> Operation:
    return Operation("union", of)


def intersection(*of: Tree) -> Operation:
    return Operation("intersection", of)


def difference(*of: Tree) -> Operation:
    return Operation("difference", of)


def box(x: float, y: float, z: float, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Leaf:
    return Leaf("box", (x, y, z), position=at)


def behind(axis: int, sign: int, offset: float) -> Leaf:
    """The half-space below ``offset`` along an axis."""
    turns = {
        (0, 1): (0.0, QUARTER, 0.0, QUARTER), (0, -1): (0.0, -QUARTER, 0.0, QUARTER),
        (1, 1): (-QUARTER, 0.0, 0.0, QUARTER), (1, -1): (QUARTER, 0.0, 0.0, QUARTER),
        (2, 1): (0.0, 0.0, 0.0, 1.0), (2, -1): (1.0, 0.0, 0.0, 0.0),
    }  # fmt: skip
    return Leaf("half_space", (offset,), turns[axis, sign])


def body(tree: Tree) -> Body | None:
    """What a tree comes to; nothing where it is empty."""
    try:
        return make_body(tree)
    except InconsistentDocument:
        return None


def volume(tree: Tree) -> float:
    found = body(tree)
    return 0.0 if found is None else float(welded(found.mesh).volume)


@settings(max_examples=60)
@given(trees(8))
def test_any_tree_is_closed_and_sound(tree: Tree) -> None:
    found = body(tree)
    assume(found is not None)
    assert found is not None
    assert_sound(found.mesh)
    assert_closed(found.mesh)


@settings(max_examples=40)
@given(trees(5), st.integers(0, 2**32 - 1))
def test_what_is_inside_is_what_the_tree_says(tree: Tree, seed: int) -> None:
    found = body(tree)
    points = np.random.default_rng(seed).uniform(-2.0, 2.0, (60, 3))
    # A circle's polygon runs inside it.
    points = points[clear_of_surfaces(tree, points, 0.01)]
    for point, inside in zip(points, contains(tree, points), strict=True):
        own = (0.0, 0.0, 0.0) if found is None else tuple((point - found.middle).tolist())
        assert inside == (found is not None and encloses(found.mesh, own))


@settings(max_examples=30)
@given(trees(4), trees(4))
def test_volumes_of_unions_and_differences_add_up(one: Tree, other: Tree) -> None:
    both = volume(intersection(one, other))
    first, second = volume(one), volume(other)
    assert volume(union(one, other)) == pytest.approx(first + second - both, abs=1e-4)
    assert volume(difference(one, other)) == pytest.approx(first - both, abs=1e-4)


@pytest.mark.parametrize(
    ("tree", "expected", "slack"),
    [
        (BLOCK, 8.0, 1e-6),
        (BALL, 4 / 3 * pi * 1.3**3, 0.006),
        (Leaf("cone", (1.0, 2.0, 0.0)), 2 / 3 * pi, 0.003),
        (Leaf("cone", (1.0, 2.0, 0.5)), 2 / 3 * pi * 1.75, 0.003),
        (intersection(BALL, behind(2, 1, 0.0)), 2 / 3 * pi * 1.3**3, 0.006),
        (difference(BLOCK, ROD), 8.0 - 2 * pi * 0.25, 0.003),
        (intersection(*(behind(axis, way, 0.5) for axis in range(3) for way in (-1, 1))), 1, 1e-6),
        (difference(BLOCK, box(1.0, 1.0, 2.0)), 6.0, 1e-6),
        (union(BLOCK, box(2.0, 2.0, 2.0, (2.0, 0.0, 0.0))), 16.0, 1e-6),
    ],
)  # fmt: skip
def test_a_body_has_the_volume_of_its_formula(tree: Tree, expected: float, slack: float) -> None:
    assert volume(tree) == pytest.approx(expected, rel=slack)


def test_a_tetrahedron_of_four_oblique_half_spaces_has_an_end() -> None:
    half = np.arccos(1 / 3**0.5) / 2
    turns = []
    for x, y, z in [(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)]:
        angle = half if z > 0 else pi / 2 - half
        axis = np.array([-y, x, 0]) / 2**0.5 * np.sin(angle)
        turns.append((*axis.tolist(), float(np.cos(angle))))
    found = make_body(intersection(*(Leaf("half_space", (1.0,), turn) for turn in turns)))
    assert len(found.mesh.faces) == 4
    assert welded(found.mesh).volume == pytest.approx(8 * 3**0.5, rel=1e-5)


def test_normals_are_those_of_the_solids_with_creases_where_they_meet() -> None:
    mesh = make_body(intersection(BLOCK, BALL)).mesh
    on_ball = np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1.3) < 1e-5
    flat = np.abs(mesh.vertices).max(axis=1) > 0.999999
    assert (flat | on_ball).all()
    np.testing.assert_allclose(mesh.normals[~flat], mesh.vertices[~flat] / 1.3, atol=0.01)
    rim = mesh.normals[flat]
    along = np.einsum("vi,vi->v", rim, mesh.vertices[flat]) / 1.3
    assert ((np.abs(rim).max(axis=1) > 0.999999) | (along > 0.995)).all()
    assert largest_deviation(mesh) < np.radians(5)


def test_the_wall_of_a_hole_faces_its_axis() -> None:
    mesh = make_body(difference(BLOCK, ROD)).mesh
    wall = np.abs(mesh.normals[:, 2]) < 0.5
    wall &= np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1]) < 0.6
    assert wall.sum() > 100
    np.testing.assert_allclose(
        mesh.normals[wall][:, :2], -mesh.vertices[wall][:, :2] / 0.5, atol=0.01
    )


def test_a_body_is_centred_and_tells_where_its_origin_was() -> None:
    found = make_body(box(1.0, 2.0, 3.0, (10.0, 20.0, 30.0)))
    assert (found.middle, found.size) == ((10.0, 20.0, 30.0), (1.0, 2.0, 3.0))
    np.testing.assert_allclose(found.mesh.bounds, [[-0.5, -1, -1.5], [0.5, 1, 1.5]], atol=1e-6)


def test_a_body_far_from_its_origin_keeps_its_form() -> None:
    found = make_body(union(*(box(1e-2, 1e-2, k * 1e-2, (1e6, 1e6, 1e6)) for k in (1, 2))))
    assert found.size == pytest.approx((0.01, 0.01, 0.02), rel=1e-3)
    assert_closed(found.mesh)


@pytest.mark.parametrize(
    ("tree", "top"),
    [
        (BLOCK, (0.0, 0.0, 1.0)),
        (BALL, (0.0, 0.0, 1.3)),
        (difference(BLOCK, box(1.0, 1.0, 2.0)), (0.0, 0.75, 1.0)),
        (difference(BLOCK, box(1.0, 1.0, 1.0, (0.0, 0.0, 1.0))), (0.0, 0.0, 0.5)),
        (box(1.0, 1.0, 1.0, (9.0, 9.0, 9.0)), (0.0, 0.0, 0.5)),
        (box(2.0, 2.0, 2.0, (0.5, 0.0, 0.0)), (-0.5, 0.0, 1.0)),
        # Two posts right and left of the axis.
        (union(box(1.0, 1.0, 2.0, (-1.0, 0.0, 0.0)), box(1.0, 1.0, 2.0, (1.0, 0.0, 0.0))),
         (1.0, 0.0, 1.0)),
    ],
)  # fmt: skip
def test_the_top_is_above_the_origin_or_on_the_rim(
    tree: Tree, top: tuple[float, float, float]
) -> None:
    assert make_body(tree).top == pytest.approx(top, abs=1e-6)


@pytest.mark.parametrize(
    ("tree", "phrase"),
    [
        (difference(BLOCK, box(3.0, 3.0, 3.0)), "Nothing is left"),
        (difference(BLOCK, BLOCK), "Nothing is left"),
        (intersection(BLOCK, box(1.0, 1.0, 1.0, (9.0, 0.0, 0.0))), "Nothing is left"),
        (intersection(behind(2, 1, -1.0), behind(2, -1, -1.0)), "Nothing is left"),
        (behind(2, 1, 0.0), "without an end"),
        (union(BLOCK, behind(0, 1, 0.0)), "without an end"),
        (difference(behind(2, 1, 0.0), BALL), "without an end"),
        (intersection(*(behind(axis, 1, 1.0) for axis in range(3))), "without an end"),
        (intersection(behind(2, 1, 1.0), behind(2, -1, 1.0)), "without an end"),
        (union(Leaf("sphere", (1e-3,)), box(1e5, 1e5, 1e5, (1e6, 0.0, 0.0))), "too small"),
        (box(1e5, 1e5, 1e-3), "so thin"),
    ],
)
def test_a_tree_that_comes_to_no_body_is_refused(tree: Tree, phrase: str) -> None:
    with pytest.raises(InconsistentDocument, match=phrase):
        make_body(tree)


def bars(axis: int, count: int) -> Operation:
    """Thin slabs one behind another."""
    slabs = []
    for number in range(count):
        size, at = [400.0] * 3, [0.0] * 3
        size[axis], at[axis] = 50.0 / count, 100.0 * number / count
        slabs.append(box(size[0], size[1], size[2], (at[0], at[1], at[2])))
    return union(*slabs)


def lattice(count: int) -> Operation:
    """Slabs along each axis, and what they have in common: so many cubes each way."""
    return intersection(*(bars(axis, count) for axis in range(3)))


@pytest.mark.parametrize("count", [40, 110, 300])
def test_bodies_that_cross_in_too_many_places_are_refused_before_they_are_made(count: int) -> None:
    def refuse() -> None:
        with pytest.raises(DocumentTooLarge, match="too many places"):
            make_body(lattice(count))

    # Twice as many bars each way cost ten times as much where they are made.
    check_costs_less(refuse, lambda: make_body(lattice(10)), times=10, tries=2)


def test_two_hundred_balls_take_no_more_than_their_number() -> None:
    random = np.random.default_rng(1)
    balls = [
        Leaf("sphere", (float(radius),), position=tuple(place))
        for radius, place in zip(
            random.uniform(0.3, 1.0, 200), random.uniform(-1.5, 1.5, (200, 3)).tolist(), strict=True
        )
    ]
    assert_closed(make_body(union(*balls)).mesh)
    check_growth(lambda count: make_body(union(*balls[:count])), 25, slack=1.0)


def test_the_same_tree_gives_the_same_bytes() -> None:
    tree = difference(intersection(BLOCK, BALL), ROD)
    one, other = make_body(tree).mesh, make_body(tree).mesh
    assert one.vertices.tobytes() == other.vertices.tobytes()
    assert one.normals.tobytes() == other.normals.tobytes()
    assert one.faces.tobytes() == other.faces.tobytes()
