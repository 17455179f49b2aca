"""How fast CURVES is: many small hyperedges, one huge one, and plain Python beside them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.curves import lay_out
from app.hyperedges.join_planes import choose_join_planes
from tests.hyperedges import paper
from tests.hyperedges.scenes import placement, upwards

ONE_OF: dict[str, Callable[[np.random.Generator, int], Floats]] = {
    "spread": lambda chance, n: chance.uniform(0, 100, (n, 3)),
    "flat": lambda chance, n: np.column_stack([chance.uniform(0, 100, (n, 2)), np.zeros(n)]),
    "coincident": lambda _, n: np.zeros((n, 3)),
    "line": lambda _, n: np.column_stack([np.arange(n), np.zeros((n, 2))]).astype(np.float64),
    "two far clusters": lambda chance, n: (
        chance.normal(0, 1e-3, (n, 3)) + 1e3 * (np.arange(n) % 2)[:, None]
    ),
}


def many(count: int, width: float) -> tuple[Floats, Indices]:
    """Hyperedges of 3 to 5 attachments, each within five units."""
    chance = np.random.default_rng(0)
    arities = chance.integers(3, 6, count)
    middles = np.repeat(chance.uniform(0, width, (count, 2)), arities, axis=0)
    points = np.column_stack([middles, np.zeros(len(middles))])
    starts = np.concatenate([[0], np.cumsum(arities)])
    return points + chance.uniform(0, [5, 5, 1], points.shape), starts


@pytest.mark.parametrize("fidelity", ["paper", "best"])
def test_many_hyperedges(benchmark: Any, fidelity: Any) -> None:
    """100,000 hyperedges of 3 to 5 attachments."""
    benchmark.group = "CURVES, hyperedges of 3 to 5 attachments"
    benchmark.extra_info["of"] = f"100,000, {fidelity}"
    points, starts = many(100_000, 1000.0)
    directions, planes = upwards(len(points)), np.full(len(starts) - 1, 3.0)
    benchmark.pedantic(
        lay_out,
        (points, directions, starts, planes),
        {"fidelity": fidelity},
        rounds=5,
        warmup_rounds=1,
    )


def test_many_hyperedges_in_plain_python(benchmark: Any) -> None:
    """1,000 of them, as the paper has it."""
    benchmark.group = "CURVES, hyperedges of 3 to 5 attachments"
    benchmark.extra_info["of"] = "1,000"
    points, starts = many(1_000, 100.0)

    def lay_out_plainly() -> None:
        for k in range(len(starts) - 1):
            paper.curves(points[starts[k] : starts[k + 1]], 3.0, "prose")

    benchmark.pedantic(lay_out_plainly, rounds=3)


@pytest.mark.parametrize("shape", ONE_OF)
def test_one_hyperedge(benchmark: Any, shape: str) -> None:
    """100,000 attachments."""
    benchmark.group = "CURVES, one hyperedge of 100,000 attachments"
    benchmark.extra_info["points"] = shape
    points = ONE_OF[shape](np.random.default_rng(0), 100_000)
    arguments = points, upwards(len(points)), np.array([0, len(points)]), np.array([3.0])
    benchmark.pedantic(lay_out, arguments, rounds=3, warmup_rounds=1)


def test_one_hyperedge_in_plain_python(benchmark: Any) -> None:
    """60 attachments, as the paper has it: the time grows with their cube."""
    benchmark.group = "CURVES, one hyperedge of 60 attachments"
    points = ONE_OF["spread"](np.random.default_rng(0), 60)
    benchmark.pedantic(paper.curves, (points, 3.0, "prose"), rounds=2)


def test_join_planes(benchmark: Any) -> None:
    """Heights of 100,000 hyperedges."""
    benchmark.group = "Join planes of 100,000 hyperedges"
    points, starts = many(100_000, 1000.0)
    arguments = placement(points, starts.tolist()), 0.05, np.full(len(starts) - 1, np.nan)
    benchmark.pedantic(choose_join_planes, arguments, rounds=3, warmup_rounds=1)
