from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.arrays import Floats
from app.hyperedges.curves import FEW, join_starts, lay_out, segment_starts
from tests.hyperedges import paper
from tests.hyperedges.scenes import (
    FIDELITIES,
    MEASURES,
    PLANE,
    READINGS,
    Fidelity,
    Measure,
    Reading,
    lay_out_one,
    troubles,
    upwards,
)

BOTH = pytest.mark.parametrize("reading", READINGS)


@BOTH
@pytest.mark.parametrize("count", range(2, 9))
def test_control_points_are_those_of_the_paper(reading: Reading, count: int) -> None:
    chance = np.random.default_rng(count)
    for _ in range(25):
        points = chance.uniform(-5, 5, (count, 3))
        expected = paper.curves(points, PLANE, reading)
        found = lay_out_one(points, reading=reading)
        wanted = np.array([curve.control_points for curve in expected])
        np.testing.assert_allclose(found.control_points, wanted, rtol=0, atol=1e-12)
        assert found.ends.tolist() == [list(curve.ends) for curve in expected]


@BOTH
@pytest.mark.parametrize("count", [FEW, FEW + 1, 64])
@pytest.mark.parametrize("name", ["random", "huge", "two far clusters", "in the join plane"])
def test_many_points_join_as_in_the_paper(reading: Reading, count: int, name: str) -> None:
    points = troubles(count)[name]
    expected = paper.curves(points, PLANE, reading)
    found = lay_out_one(points, reading=reading)
    wanted = np.array([curve.control_points for curve in expected])
    scale = float(np.abs(points).max())
    assert found.ends.tolist() == [list(curve.ends) for curve in expected]
    np.testing.assert_allclose(found.control_points, wanted, rtol=0, atol=1e-12 * scale)


@BOTH
def test_plane_measures_what_is_closest_from_above(reading: Reading) -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0, 9], [7, 0, 0]], dtype=np.float64)
    in_space = lay_out_one(points, reading=reading)
    in_plane = lay_out_one(points, reading=reading, closest="plane")
    expected = paper.curves(points, PLANE, reading, dimensions=2)
    assert in_space.ends[:2].tolist() == [[0, 4], [1, 4]]
    assert in_plane.ends[:2].tolist() == [[0, 4], [2, 4]]
    np.testing.assert_allclose(
        in_plane.control_points, [curve.control_points for curve in expected], atol=1e-12
    )


@BOTH
def test_two_points_by_hand(reading: Reading) -> None:
    found = lay_out_one(np.array([[0, 0, 1], [6, 3, 0]]), 4.0, reading=reading)
    assert found.control_points.tolist() == [[[0, 0, 1], [2, 1, 4], [4, 2, 4], [6, 3, 0]]]
    assert found.ends.tolist() == [[0, 1]]
    assert found.joins.shape == found.tangents.shape == (0, 3)


THREE = np.array([[0, 0, 0], [6, 0, 0], [3, 18, 0]])
"""C is the third point, and the join lies at (4 - 1, 18 / 3) in the plane."""


def test_three_points_by_hand_in_prose() -> None:
    found = lay_out_one(THREE, 6.0, reading="prose")
    # J = (M + A1 + A2) / 3 = (3, 2, 2), F = 2M - J = (3, 10, 10), (F + P2) / 2 = (3, 14, 5).
    assert found.control_points.tolist() == [
        [[0, 0, 0], [1.5, 3, 3], [3, 2, 2], [3, 6, 6]],
        [[6, 0, 0], [4.5, 3, 3], [3, 2, 2], [3, 6, 6]],
        [[3, 6, 6], [3, 10, 10], [3, 14, 5], [3, 18, 0]],
    ]
    assert found.ends.tolist() == [[0, 3], [1, 3], [3, 2]]
    assert found.joins.tolist() == [[3, 6, 6]]
    np.testing.assert_allclose(found.tangents, [[0, 0.5**0.5, 0.5**0.5]], rtol=1e-15)


def test_three_points_by_hand_in_symbols() -> None:
    found = lay_out_one(THREE, 6.0, reading="symbolic")
    # C = (3, 18, 0), F = 2M - C = (3, -6, 12), (F + P2) / 2 = (3, 6, 6).
    assert found.control_points.tolist() == [
        [[0, 0, 0], [1.5, 3, 3], [3, 18, 0], [3, 6, 6]],
        [[6, 0, 0], [4.5, 3, 3], [3, 18, 0], [3, 6, 6]],
        [[3, 6, 6], [3, -6, 12], [3, 6, 6], [3, 18, 0]],
    ]
    np.testing.assert_allclose(found.tangents, [[0, -2 / 5**0.5, 1 / 5**0.5]], rtol=1e-15)


@pytest.mark.parametrize("fidelity", FIDELITIES)
@BOTH
@pytest.mark.parametrize("count", [3, 5, 8, 60])
def test_the_three_segments_of_a_join_share_its_tangent(
    fidelity: Fidelity, reading: Reading, count: int
) -> None:
    points = np.random.default_rng(count).uniform(-5, 5, (count, 3))
    found = lay_out_one(points, reading=reading, fidelity=fidelity)
    for join, tangent in enumerate(found.tangents, start=count):
        entering = found.control_points[found.ends[:, 1] == join][:, [2, 3]]
        leaving = found.control_points[found.ends[:, 0] == join][:, [0, 1]]
        if len(leaving) == 0:  # the last segment may end at this join: it leaves in reverse
            entering, last = entering[:-1], entering[-1]
            leaving = last[None, ::-1]
        assert len(entering) == 2
        assert len(leaving) == 1
        for begin, end in (*entering, *leaving):
            direction = (end - begin) / np.linalg.norm(end - begin)
            np.testing.assert_allclose(direction, tangent, rtol=0, atol=1e-9)


@given(st.lists(st.integers(2, 60), max_size=6), st.sampled_from(READINGS))
@settings(max_examples=60)
def test_segments_number_twice_the_joins_and_one(arities: list[int], reading: Reading) -> None:
    starts = np.concatenate([[0], np.cumsum(arities, dtype=np.int64)]).astype(np.int64)
    points = np.random.default_rng(0).uniform(-5, 5, (int(starts[-1]), 3))
    found = lay_out(
        points, upwards(len(points)), starts, np.full(len(arities), PLANE), reading=reading
    )
    assert np.diff(segment_starts(starts)).tolist() == [2 * (n - 2) + 1 for n in arities]
    assert np.diff(join_starts(starts)).tolist() == [n - 2 for n in arities]
    assert len(found.control_points) == len(found.ends) == segment_starts(starts)[-1]
    assert len(found.joins) == len(found.tangents) == join_starts(starts)[-1]
    for k, count in enumerate(arities):
        ends = found.ends[segment_starts(starts)[k] : segment_starts(starts)[k + 1]]
        uses = np.bincount(ends.ravel(), minlength=2 * count - 2)
        assert uses.tolist() == [1] * count + [3] * (count - 2)


def test_hyperedges_do_not_know_of_each_other() -> None:
    chance = np.random.default_rng(1)
    arities = [3, 2, 90, 5, 41, 4]
    starts = np.concatenate([[0], np.cumsum(arities)])
    points = chance.uniform(-5, 5, (int(starts[-1]), 3))
    planes = chance.uniform(1, 4, len(arities))
    together = lay_out(points, upwards(len(points)), starts, planes)
    segments, joins = segment_starts(starts), join_starts(starts)
    for k, plane in enumerate(planes):
        alone = lay_out_one(points[starts[k] : starts[k + 1]], plane, fidelity="best")
        segment, join = slice(segments[k], segments[k + 1]), slice(joins[k], joins[k + 1])
        np.testing.assert_array_equal(together.control_points[segment], alone.control_points)
        np.testing.assert_array_equal(together.ends[segment], alone.ends)
        np.testing.assert_array_equal(together.joins[join], alone.joins)
        np.testing.assert_array_equal(together.tangents[join], alone.tangents)


def test_of_pairs_equally_close_the_smallest_numbers_come_first() -> None:
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    assert lay_out_one(square).ends[:2].tolist() == [[0, 4], [1, 4]]
    turned = lay_out_one(square[[0, 2, 1, 3]])
    assert turned.ends[:2].tolist() == [[0, 4], [2, 4]]


def test_a_join_comes_after_all_attachments() -> None:
    # The join of 0 and 1 falls on (2, 0, 3), as far from 2 as 3 is.
    points = np.array([[1, 0, 3], [1.5, 0, 3], [3, 0, 3], [4, 0, 3]])
    found = lay_out_one(points)
    assert found.joins[0].tolist() == [2, 0, 3]
    assert found.ends[2:4].tolist() == [[2, 5], [3, 5]]


@BOTH
@pytest.mark.parametrize("closest", MEASURES)
@pytest.mark.parametrize("count", [FEW + 1, 130, 420])
def test_tree_and_direct_search_agree_to_the_last_bit(
    reading: Reading, closest: Measure, count: int
) -> None:
    for name, points in troubles(count).items():
        tree = lay_out_one(points, reading=reading, closest=closest)
        direct = lay_out_one(points, reading=reading, closest=closest, search="direct")
        for found, expected in zip(tree, direct, strict=True):
            assert found.tobytes() == expected.tobytes(), name


@given(arrays(np.float64, st.tuples(st.integers(41, 70), st.just(3)), elements=st.integers(-2, 2)))
@settings(max_examples=100)
def test_tree_and_direct_search_agree_among_ties(points: Floats) -> None:
    tree, direct = lay_out_one(points), lay_out_one(points, search="direct")
    assert tree.ends.tolist() == direct.ends.tolist()


@pytest.mark.parametrize("fidelity", FIDELITIES)
@BOTH
@pytest.mark.parametrize("count", [2, 3, 4, 7, 50])
def test_trouble_leaves_all_numbers_finite(
    fidelity: Fidelity, reading: Reading, count: int
) -> None:
    for name, points in troubles(count).items():
        for plane in (PLANE, 0.0, -1e6):
            found = lay_out_one(points, plane, reading=reading, fidelity=fidelity)
            assert np.isfinite(found.control_points).all(), name
            lengths = np.linalg.norm(found.tangents, axis=1)
            np.testing.assert_allclose(lengths, 1.0, atol=1e-12, err_msg=name)


def test_a_join_may_fall_on_an_attachment() -> None:
    points = np.array([[-1, 0, 3], [1, 0, 3], [0, 0, 3]])
    found = lay_out_one(points, fidelity="best")
    # 0 and 2 are joined, 1 is left: M = (0, 0, 3), where 2 is, and its handle has no length.
    assert found.ends.tolist() == [[0, 3], [2, 3], [3, 1]]
    assert found.joins.tolist() == [[0, 0, 3]]
    assert found.control_points[1, [0, 1, 3]].tolist() == [[0, 0, 3]] * 3
    np.testing.assert_allclose(found.tangents, [[1, 0, 0]])


def test_where_all_points_are_one_the_tangent_is_x() -> None:
    found = lay_out_one(np.tile([0.0, 0.0, 3.0], (3, 1)), fidelity="best")
    assert (found.control_points == [0, 0, 3]).all()
    assert found.tangents.tolist() == [[1, 0, 0]]


def test_curves_that_meet_head_on_have_their_line_as_tangent() -> None:
    # C lies in the middle of the two points joined, in the join plane: J = M.
    points = np.array([[-2, 0, 3], [2, 0, 3], [0, 20, 3], [0, -20, 3]])
    found = lay_out_one(points)
    assert found.joins[0].tolist() == [0, 0, 3]
    assert found.tangents[0].tolist() == [1, 0, 0]


@pytest.mark.parametrize("shift", [(64.0, -32.0, 0.0), (1.0, 2.0, 3.0)])
def test_curves_move_with_their_points(shift: tuple[float, float, float]) -> None:
    points = np.random.default_rng(3).uniform(-5, 5, (60, 3))
    here, there = lay_out_one(points), lay_out_one(points + shift, PLANE + shift[2])
    assert here.ends.tolist() == there.ends.tolist()
    np.testing.assert_allclose(here.control_points + shift, there.control_points, atol=1e-11)


def test_the_same_points_give_the_same_bytes() -> None:
    points = np.random.default_rng(4).uniform(-5, 5, (300, 3))
    for first, second in zip(lay_out_one(points), lay_out_one(points), strict=True):
        assert first.tobytes() == second.tobytes()


@BOTH
@pytest.mark.parametrize("count", [2, 3, 6, 50])
def test_best_curves_leave_attachments_squarely_and_else_are_the_paper_s(
    reading: Reading, count: int
) -> None:
    chance = np.random.default_rng(count)
    points = chance.uniform(-5, 5, (count, 3))
    directions = chance.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    exact = lay_out_one(points, reading=reading, directions=directions)
    best = lay_out_one(points, reading=reading, directions=directions, fidelity="best")
    np.testing.assert_array_equal(best.ends, exact.ends)
    np.testing.assert_array_equal(best.tangents, exact.tangents)
    for ends, turned, plain in zip(
        best.ends, best.control_points, exact.control_points, strict=True
    ):
        for end, corner, interior in ((ends[0], 0, 1), (ends[1], 3, 2)):
            handle = turned[interior] - turned[corner]
            if end >= count:
                np.testing.assert_array_equal(turned[interior], plain[interior])
            else:
                length = np.linalg.norm(plain[interior] - plain[corner])
                np.testing.assert_allclose(handle, length * directions[end], atol=1e-12)
        np.testing.assert_array_equal(turned[[0, 3]], plain[[0, 3]])


def test_a_large_hyperedge_is_joined_whole() -> None:
    count = 20_000
    for points in (
        np.random.default_rng(5).uniform(0, 100, (count, 3)),
        np.zeros((count, 3)),
        np.tile([1.0, 1.0, PLANE], (count, 1)),
        np.column_stack([np.arange(count), np.zeros((count, 2))]).astype(np.float64),
        np.random.default_rng(5).normal(0, 1e-3, (count, 3))
        + 1e3 * (np.arange(count) % 2)[:, None],
    ):
        found = lay_out_one(points)
        assert np.isfinite(found.control_points).all()
        uses = np.bincount(found.ends.ravel())
        assert (uses[:count] == 1).all()
        assert (uses[count:] == 3).all()


def test_one_attachment_is_no_hyperedge() -> None:
    with pytest.raises(ValueError, match="two or more"):
        lay_out_one(np.zeros((1, 3)))


def test_no_hyperedges_give_no_curves() -> None:
    nothing = np.zeros((0, 3))
    found = lay_out(nothing, nothing, np.zeros(1, dtype=np.int64), np.zeros(0))
    assert [len(part) for part in found] == [0, 0, 0, 0]
