from __future__ import annotations

from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.arrays import Floats
from app.hyperedges.steiner.trees import short_trees
from benchmarks.shortest_trees import shortest_tree
from tests.hyperedges.scenes import troubles
from tests.hyperedges.steiner.measures import (
    is_tree,
    lengths,
    short_length,
    short_tree,
    spanning_length,
)

COORDINATE = st.integers(-1000, 1000).map(lambda thousandths: thousandths / 1000)


def clouds(least: int, most: int) -> st.SearchStrategy[Floats]:
    point = st.tuples(COORDINATE, COORDINATE, COORDINATE)
    return st.lists(point, min_size=least, max_size=most).map(np.array)


def polygon(corners: int) -> Floats:
    angles = 2 * np.pi * np.arange(corners) / corners
    return np.column_stack([np.cos(angles), np.sin(angles)])


def turned(points: Floats, seed: int) -> Floats:
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return np.asarray(points @ rotation)


@pytest.mark.parametrize(
    ("points", "length"),
    [
        (polygon(3) / sqrt(3), sqrt(3)),
        (polygon(4) / sqrt(2), 1 + sqrt(3)),
        # From six corners on, the polygon without one side is shortest (Du, Hwang and Weng 1987).
        (polygon(6), 5),
        (polygon(12), 11 * 2 * np.sin(np.pi / 12)),
        # The regular tetrahedron of side one.
        (
            np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / sqrt(8),
            sqrt(3) + sqrt(0.5),
        ),
        # A rectangle, and a line.
        (np.array([[0.0, 0], [3, 0], [3, 1], [0, 1]]), 3 + sqrt(3)),
        (np.array([[0.0, 0], [1, 0], [3, 0], [7, 0]]), 7),
    ],
)
def test_trees_that_are_known(points: Floats, length: float) -> None:
    assert short_length(points) == pytest.approx(length, rel=1e-9)


def test_the_corners_of_a_regular_pentagon_have_three_joins() -> None:
    trees = short_tree(polygon(5))
    nodes = np.concatenate([polygon(5), trees.joins])
    edges = nodes[trees.edges]
    assert np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).min() > 0.01
    assert short_length(polygon(5)) == pytest.approx(shortest_tree(polygon(5)).length, rel=1e-6)


def test_two_attachments_are_joined_directly() -> None:
    trees = short_trees(np.array([[0.0, 0], [1, 1], [5, 5], [6, 6]]), np.array([0, 2, 4]))
    assert trees.edges.tolist() == [[0, 1], [0, 1]]
    assert trees.edge_starts.tolist() == [0, 1, 2]
    assert trees.joins.shape == (0, 2)
    assert trees.join_starts.tolist() == [0, 0, 0]


def test_no_hyperedges_have_no_trees() -> None:
    trees = short_trees(np.zeros((0, 3)), np.array([0]))
    assert trees.joins.shape == (0, 3)
    assert trees.edges.shape == (0, 2)


def test_one_attachment_is_refused() -> None:
    with pytest.raises(ValueError, match="two or more"):
        short_trees(np.zeros((3, 3)), np.array([0, 2, 3]))


def test_hyperedges_do_not_know_each_other() -> None:
    points = np.random.default_rng(0).uniform(0, 9, (40, 3))
    starts = np.array([0, 2, 5, 20, 24, 40])
    trees = short_trees(points, starts)
    for k in range(5):
        alone = short_tree(points[starts[k] : starts[k + 1]])
        joins = trees.joins[trees.join_starts[k] : trees.join_starts[k + 1]]
        assert joins.tobytes() == alone.joins.tobytes()
        edges = trees.edges[trees.edge_starts[k] : trees.edge_starts[k + 1]]
        assert edges.tolist() == alone.edges.tolist()


@pytest.mark.parametrize("count", [3, 4, 9, 60, 500])
def test_trouble_has_trees_no_longer_than_spanning_ones(count: int) -> None:
    for name, points in troubles(count).items():
        trees = short_tree(points)
        assert np.isfinite(trees.joins).all(), name
        assert is_tree(trees.edges, 2 * count - 2), name
        longest = spanning_length(points) * (1 + 1e-12)
        assert short_length(points) <= longest, name


@given(clouds(3, 12))
def test_attachments_are_leaves_and_joins_have_three_arms(points: Floats) -> None:
    n = len(points)
    edges = short_tree(points).edges
    assert is_tree(edges, 2 * n - 2)
    assert np.bincount(edges.ravel()).tolist() == [1] * n + [3] * (n - 2)


@given(clouds(3, 12))
def test_edges_are_in_order(points: Floats) -> None:
    n = len(points)
    edges = short_tree(points).edges
    assert edges[:n, 0].tolist() == list(range(n))
    assert edges[0].tolist() == [0, n]
    assert edges[n:, 1].tolist() == list(range(n + 1, 2 * n - 2))
    assert (edges[:, 0] < edges[:, 1]).all()


@given(clouds(2, 12))
def test_no_tree_is_longer_than_the_minimum_spanning_tree(points: Floats) -> None:
    assert short_length(points) <= spanning_length(points) * (1 + 1e-12)


@settings(max_examples=40)
@given(clouds(3, 6))
def test_no_tree_is_shorter_than_the_shortest_is_proven_to_be(points: Floats) -> None:
    shortest = shortest_tree(points)
    assert short_length(points) >= shortest.bound * (1 - 1e-12)
    assert shortest.length * (1 + 1e-12) >= shortest.bound >= shortest.length * (1 - 1e-4)


@given(clouds(3, 4))
def test_three_or_four_attachments_have_the_shortest_tree(points: Floats) -> None:
    assert short_length(points) <= shortest_tree(points).length * (1 + 1e-6)


def test_trees_of_eight_are_the_shortest_but_for_little() -> None:
    chance = np.random.default_rng(1)
    points = chance.uniform(0, 20, (240, 2))
    starts = 8 * np.arange(31)
    found = lengths(points, starts, short_trees(points, starts))
    shortest = [shortest_tree(part).length for part in np.split(points, starts[1:-1])]
    assert (found / shortest).mean() < 1.003
    assert (found / shortest).max() < 1.03


@given(clouds(3, 12), st.integers(0, 9), st.sampled_from([1e-3, 0.7, 3.0, 1e5]))
def test_turning_and_scaling_keep_the_length(points: Floats, seed: int, scale: float) -> None:
    # Ties may fall otherwise, and lead to another tree: random points have none.
    points = points + np.random.default_rng(seed).normal(0, 0.1, points.shape)
    found = short_length(scale * turned(points, seed))
    assert found == pytest.approx(scale * short_length(points), rel=1e-6)


@given(clouds(3, 12), st.integers(0, 99))
def test_another_order_of_attachments_changes_the_length_little(points: Floats, seed: int) -> None:
    order = np.random.default_rng(seed).permutation(len(points))
    assert short_length(points[order]) == pytest.approx(short_length(points), rel=0.05)


@given(clouds(3, 12))
def test_the_same_points_have_the_same_tree_to_the_byte(points: Floats) -> None:
    one, other = short_tree(points), short_tree(points.copy())
    assert one.joins.tobytes() == other.joins.tobytes()
    assert one.edges.tobytes() == other.edges.tobytes()


@given(clouds(3, 12), st.integers(-30, 30))
def test_powers_of_two_scale_to_the_bit(points: Floats, exponent: int) -> None:
    found = short_tree(points * 2.0**exponent).joins
    assert (found == short_tree(points).joins * 2.0**exponent).all()


@pytest.mark.parametrize("count", [3, 8, 30, 500])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_arms_of_a_join_are_120_degrees_apart(count: int, dimensions: int) -> None:
    points = np.random.default_rng(count).uniform(0, 20, (count, dimensions))
    trees = short_tree(points)
    nodes = np.concatenate([points, trees.joins])
    checked = 0
    for join in range(count, 2 * count - 2):
        ends = trees.edges[(trees.edges == join).any(axis=1)].sum(axis=1) - join
        arms = nodes[ends] - nodes[join]
        sizes = np.linalg.norm(arms, axis=1)
        if sizes.min() > 1e-3:
            arms /= sizes[:, None]
            products = [arms[0] @ arms[1], arms[0] @ arms[2], arms[1] @ arms[2]]
            assert products == pytest.approx([-0.5] * 3, abs=1e-6)
            checked += 1
    assert checked >= count // 4


def test_a_join_that_belongs_on_an_attachment_is_exactly_there() -> None:
    points = np.array([[1e5 - 0.3, 0.1], [1e5 + 0.1, 0.2], [1e5 + 0.7, 0.1]])
    assert short_tree(points).joins.tolist() == [points[1].tolist()]


def test_features_of_a_thousandth_far_from_the_origin_are_found() -> None:
    points = polygon(3) * 1e-3 + 1e5
    assert short_length(points) == pytest.approx(3e-3, rel=1e-6)
