"""How short our trees are, and how fast they come: beside the shortest, the paper's, and spanning.

Lengths are ratios, mean and worst, over hyperedges of points spread evenly over a square or cube.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.curves import lay_out
from app.hyperedges.steiner.trees import Trees, short_trees
from benchmarks.shortest_trees import shortest_tree
from tests.hyperedges.scenes import upwards
from tests.hyperedges.steiner.measures import lengths, spanning_length


def many(arity: int, hyperedges: int, dimensions: int) -> tuple[Floats, Indices]:
    """Points and starts of hyperedges all alike."""
    points = np.random.default_rng(arity).uniform(0, 20, (arity * hyperedges, dimensions))
    return points, arity * np.arange(hyperedges + 1)


def paper_trees(points: Floats, starts: Indices) -> Trees:
    """The joins that the paper makes, at the mean height of the points, with straight edges."""
    solid = np.zeros((len(points), 3))
    solid[:, : points.shape[1]] = points
    planes = np.add.reduceat(solid[:, 2], starts[:-1]) / np.diff(starts)
    curves = lay_out(solid, upwards(len(solid)), starts, planes)
    hyperedges = np.arange(len(starts))
    joins = curves.joins[:, : points.shape[1]]
    return Trees(joins, starts - 2 * hyperedges, curves.ends, 2 * starts - 3 * hyperedges)


def mean_and_worst(ratios: Floats) -> str:
    """As it stands in a table."""
    return f"{ratios.mean():.4f}, at most {ratios.max():.4f}"


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("arity", [3, 4, 5, 6, 7, 8])
def test_trees_of_few(benchmark: Any, arity: int, dimensions: int) -> None:
    """100 hyperedges, beside the shortest trees."""
    benchmark.group = f"Short trees of few attachments in {dimensions} dimensions"
    points, starts = many(arity, 100, dimensions)
    trees = benchmark.pedantic(short_trees, (points, starts), rounds=5, warmup_rounds=1)
    proofs = [shortest_tree(part) for part in np.split(points, starts[1:-1])]
    shortest = np.array([proof.length for proof in proofs])
    proven = np.array([proof.bound for proof in proofs])
    ours = lengths(points, starts, trees) / shortest
    benchmark.extra_info["of"] = f"100 × {arity}"
    benchmark.extra_info["over the shortest"] = mean_and_worst(ours)
    benchmark.extra_info["paper's"] = mean_and_worst(
        lengths(points, starts, paper_trees(points, starts)) / shortest
    )
    benchmark.extra_info["proven within"] = f"{(shortest / proven).max() - 1:.0e}"
    assert ours.min() > 1 - 1e-6
    assert ours.mean() <= 1.03


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize(("arity", "hyperedges"), [(20, 100), (100, 20), (1000, 4)])
def test_trees_of_many(benchmark: Any, arity: int, hyperedges: int, dimensions: int) -> None:
    """Beside minimum spanning trees."""
    benchmark.group = f"Short trees of many attachments in {dimensions} dimensions"
    points, starts = many(arity, hyperedges, dimensions)
    trees = benchmark.pedantic(short_trees, (points, starts), rounds=3, warmup_rounds=1)
    spanning = np.array([spanning_length(part) for part in np.split(points, starts[1:-1])])
    ours = lengths(points, starts, trees) / spanning
    benchmark.extra_info["of"] = f"{hyperedges} × {arity}"
    benchmark.extra_info["over spanning"] = mean_and_worst(ours)
    benchmark.extra_info["paper's"] = mean_and_worst(
        lengths(points, starts, paper_trees(points, starts)) / spanning
    )
    assert ours.max() <= 1.0


@pytest.mark.parametrize("arity", [3, 5, 100_000])
def test_trees_at_scale(benchmark: Any, arity: int) -> None:
    """100,000 hyperedges, or attachments of one."""
    hyperedges = 1 if arity == 100_000 else 100_000
    benchmark.group = "Short trees at scale"
    benchmark.extra_info["of"] = f"{hyperedges:,} × {arity:,}"
    points, starts = many(arity, hyperedges, 3)
    benchmark.pedantic(short_trees, (points, starts), rounds=2, warmup_rounds=1)
