from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.arrays import Floats
from app.hyperedges.curves import DIRECT, Curves, Reading, lay_out
from tests.hyperedges.reference import curves as reference

READINGS: tuple[Reading, ...] = ("prose", "symbolic")
PLANE = 3.0


def laid(points: Floats, **wishes: object) -> Curves:
    ups = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return lay_out(points, ups, np.array([0, len(points)]), np.array([PLANE]), **wishes)  # type: ignore[arg-type]


def clouds(least: int = 2, most: int = 12) -> st.SearchStrategy[Floats]:
    """Points of which some coincide, and some are equally far apart."""
    return st.integers(least, most).flatmap(
        lambda count: arrays(np.float64, (count, 3), elements=st.integers(-4, 4).map(float))
    )


def test_two_attachments_are_joined_by_thirds_in_the_join_plane() -> None:
    points = np.array([[0.0, 0.0, 1.0], [6.0, 3.0, 0.0]])
    expected = [[[0, 0, 1], [2, 1, 3], [4, 2, 3], [6, 3, 0]]]
    for reading in READINGS:
        np.testing.assert_allclose(laid(points, reading=reading).control_points, expected)


def test_three_attachments_by_the_words_as_worked_by_hand() -> None:
    # Closest: the first two. C = (6, 6, 0), M = (8/3, 2, 3), J = centroid of M and both.
    points = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [6.0, 6.0, 0.0]])
    join = [8 / 3, 2, 3]
    interior = [14 / 9, 2 / 3, 1]
    following = [34 / 9, 10 / 3, 5]
    expected: list[Any] = [
        [[0, 0, 0], [4 / 3, 1, 1.5], interior, join],
        [[2, 0, 0], [7 / 3, 1, 1.5], interior, join],
        [[6, 6, 0], [44 / 9, 14 / 3, 2.5], following, join],
    ]
    np.testing.assert_allclose(laid(points).control_points, expected, atol=1e-14)


def test_three_attachments_by_the_symbols_as_worked_by_hand() -> None:
    points = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [6.0, 6.0, 0.0]])
    join = [8 / 3, 2, 3]
    expected: list[Any] = [
        [[0, 0, 0], [4 / 3, 1, 1.5], [6, 6, 0], join],
        [[2, 0, 0], [7 / 3, 1, 1.5], [6, 6, 0], join],
        [[6, 6, 0], [8 / 3, 2, 3], [-2 / 3, -2, 6], join],
    ]
    np.testing.assert_allclose(
        laid(points, reading="symbolic").control_points, expected, atol=1e-14
    )


@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize("count", range(2, 9))
def test_control_points_equal_the_formulas(reading: Reading, count: int) -> None:
    random = np.random.default_rng(count)
    for _ in range(20):
        points = random.uniform(-10, 10, (count, 3))
        made = laid(points, reading=reading).control_points
        np.testing.assert_allclose(
            made, reference(points, PLANE, reading == "prose"), rtol=0, atol=1e-12
        )


@settings(deadline=None)
@given(clouds(), st.sampled_from(READINGS), st.sampled_from(["space", "plane"]))
def test_ties_and_coincident_points_follow_the_formulas_too(
    points: Floats, reading: Reading, closest: str
) -> None:
    made = laid(points, reading=reading, closest=closest).control_points
    expected = reference(points, PLANE, reading == "prose", 3 if closest == "space" else 2)
    np.testing.assert_allclose(made, expected, rtol=0, atol=1e-11)


@settings(deadline=None)
@given(clouds(), st.booleans())
def test_a_hyperedge_of_n_attachments_has_2n_minus_3_segments(points: Floats, square: bool) -> None:
    made = laid(points, square=square)
    assert len(made.control_points) == 2 * (len(points) - 2) + 1
    assert len(made.joins) == len(points) - 2
    assert np.isfinite(made.control_points).all()
    np.testing.assert_allclose(np.linalg.norm(made.tangents, axis=1), 1.0)


@settings(deadline=None)
@given(clouds(least=3), st.booleans())
def test_the_ends_make_a_tree_with_three_segments_at_each_join(
    points: Floats, square: bool
) -> None:
    made = laid(points, square=square)
    count = len(points)
    degrees = np.bincount(made.ends.ravel(), minlength=2 * count - 2)
    assert (degrees[:count] == 1).all()
    assert (degrees[count:] == 3).all()
    places = np.concatenate([points, made.joins])
    np.testing.assert_array_equal(made.control_points[:, 0], places[made.ends[:, 0]])
    np.testing.assert_array_equal(made.control_points[:, 3], places[made.ends[:, 1]])


@settings(deadline=None)
@given(st.integers(3, 30), st.integers(0, 2**32), st.booleans(), st.sampled_from(READINGS))
def test_tangents_at_joins_agree(count: int, seed: int, square: bool, reading: Reading) -> None:
    points = np.random.default_rng(seed).uniform(-10, 10, (count, 3))
    made = laid(points, square=square, reading=reading)
    for segment, (start, end) in zip(made.control_points, made.ends, strict=True):
        for join, handle in ((start, segment[1] - segment[0]), (end, segment[3] - segment[2])):
            if join >= count and np.linalg.norm(handle) > 1e-6:
                along = handle / np.linalg.norm(handle)
                across = np.linalg.norm(np.cross(along, made.tangents[join - count]))
                assert across < 1e-9


def test_square_tubes_leave_along_their_direction_and_are_otherwise_the_papers() -> None:
    points = np.random.default_rng(5).uniform(-10, 10, (6, 3))
    square, paper = laid(points, square=True), laid(points)
    attached = paper.ends[:, 0] < 6
    handles = square.control_points[attached, 1] - square.control_points[attached, 0]
    lengths = np.linalg.norm(
        paper.control_points[attached, 1] - points[paper.ends[attached, 0]], axis=1
    )
    np.testing.assert_allclose(handles, lengths[:, None] * [0.0, 0.0, 1.0], atol=1e-12)
    np.testing.assert_array_equal(square.joins, paper.joins)
    np.testing.assert_array_equal(square.control_points[:-1, 2], paper.control_points[:-1, 2])


@pytest.mark.parametrize("closest", ["space", "plane"])
@pytest.mark.parametrize("count", [DIRECT + 1, DIRECT + 15])
def test_many_attachments_give_the_same_tree_as_the_definition(count: int, closest: str) -> None:
    random = np.random.default_rng(count)
    for points in (random.uniform(-9, 9, (count, 3)), np.round(random.uniform(-2, 2, (count, 3)))):
        made = laid(points, closest=closest).control_points
        expected = reference(points, PLANE, prose=True, dimensions=3 if closest == "space" else 2)
        np.testing.assert_allclose(made, expected, rtol=0, atol=1e-11)


def test_hyperedges_do_not_see_each_other() -> None:
    random = np.random.default_rng(1)
    counts = [2, 5, 3, DIRECT + 5, 2, 4]
    starts = np.concatenate([[0], np.cumsum(counts)])
    points = random.uniform(-9, 9, (starts[-1], 3))
    planes = random.uniform(1, 5, len(counts))
    ups = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    together = lay_out(points, ups, starts, planes)
    alone = [
        lay_out(points[a:b], ups[a:b], np.array([0, b - a]), planes[k : k + 1])
        for k, (a, b) in enumerate(pairwise(starts))
    ]
    for number in range(4):
        np.testing.assert_array_equal(
            together[number], np.concatenate([one[number] for one in alone])
        )


@pytest.mark.parametrize("scale", [1e-3, 1e6])
def test_large_and_small_coordinates_stay_finite(scale: float) -> None:
    points = np.random.default_rng(3).uniform(-scale, scale, (200, 3))
    assert np.isfinite(laid(points).control_points).all()


def test_thousands_of_coincident_attachments_are_no_trouble() -> None:
    made = laid(np.ones((3000, 3)))
    assert len(made.control_points) == 2 * 3000 - 3
    assert np.isfinite(made.control_points).all()
