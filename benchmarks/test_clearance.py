"""How fast the certificate is: one pair of curves, and whole programs of local hyperedges."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.arrays import Floats, Indices
from app.hyperedges.clearance.certificate import certify
from app.hyperedges.clearance.pairs import gaps, near_pairs
from app.hyperedges.route import route
from app.placement.placement import Placement
from app.solids.solid import Box

CLEARANCE = 0.05
PITCH = 2.6
"""Between the middles of items of size 1."""


def local_program(hyperedges: int) -> Placement:
    """As many items in rows, and hyperedges of two to five of them, at most four rows apart."""
    chance = np.random.default_rng(0)
    items = max(hyperedges, 20)
    side = int(np.ceil(np.sqrt(items)))
    cells = np.stack(np.divmod(np.arange(items), side), axis=1)
    centers = np.column_stack([PITCH * cells, np.full(items, 0.5)])
    arities = chance.integers(2, 6, hyperedges)
    homes = np.repeat(chance.integers(0, items, hyperedges), arities)
    near = np.clip(cells[homes] + chance.integers(-2, 3, (len(homes), 2)), 0, side - 1)
    attached = np.minimum(near[:, 0] * side + near[:, 1], items - 1)
    on_top = np.column_stack(
        [chance.uniform(-0.45, 0.45, (len(attached), 2)), np.full(len(attached), 0.5)]
    )
    return Placement(
        centers=centers,
        rotations=np.tile([0.0, 0.0, 0.0, 1.0], (items, 1)),
        sizes=np.ones((items, 3)),
        solids=(Box((1.0, 1.0, 1.0), 0.05),) * items,
        labels=(None,) * items,
        attachment_positions=centers[attached] + on_top,
        attachment_directions=np.tile([0.0, 0.0, 1.0], (len(attached), 1)),
        attachment_starts=np.concatenate([[0], np.cumsum(arities)]),
        attachment_items=attached,
        radii=chance.uniform(0.1, 0.2, hyperedges),
    )


@pytest.mark.parametrize("hyperedges", [10, 30, 100, 1_000, 10_000])
def test_certificate(benchmark: Any, hyperedges: int) -> None:
    """Curves against curves, against items and against themselves."""
    benchmark.group = "Certificate of hyperedges of 2 to 5 attachments"
    placement = local_program(hyperedges)
    routing = route(placement, curves="prose", clearance=CLEARANCE)
    found = benchmark.pedantic(certify, (routing, placement, CLEARANCE), rounds=5, warmup_rounds=1)
    benchmark.extra_info["of"] = f"{hyperedges:,}"
    benchmark.extra_info["segments"] = f"{len(routing.control_points):,}"
    benchmark.extra_info["conflicts"] = f"{len(found.conflicts):,}"


def crossing_curves(count: int) -> tuple[Floats, Indices]:
    """Pairs of curves of length 3 whose middles are at most one apart."""
    chance = np.random.default_rng(0)
    curves = chance.normal(size=(2 * count, 4, 3))
    curves[1::2] += chance.uniform(-0.5, 0.5, (count, 1, 3))
    return curves, np.arange(2 * count).reshape(-1, 2)


@pytest.mark.parametrize(
    ("enough", "tolerance"), [(0.05, 0.01), (np.inf, 0.1), (np.inf, 0.01), (np.inf, 1e-6)]
)
def test_pairs_of_curves(benchmark: Any, enough: float, tolerance: float) -> None:
    """Distances of curves that are wound around each other: no pair is easy."""
    benchmark.group = "Distance of 10,000 pairs of curves"
    curves, pairs = crossing_curves(10_000)
    radii = np.full(len(curves), 0.01)
    goal = "to" if np.isinf(enough) else f"at least {enough}, else to"
    benchmark.extra_info["bounds"] = f"{goal} {tolerance:g}"
    benchmark.pedantic(gaps, (curves, radii, pairs, enough, tolerance), rounds=5, warmup_rounds=1)


def test_pairs_of_curves_by_sampling(benchmark: Any) -> None:
    """100 of them, 64 points on each, which proves nothing."""
    benchmark.group = "Distance of 10,000 pairs of curves"
    benchmark.extra_info["of"] = "100"
    curves, pairs = crossing_curves(100)
    t = np.linspace(0, 1, 64)[:, None]
    r = 1 - t
    weights = np.hstack([r**3, 3 * r**2 * t, 3 * r * t**2, t**3])

    def sample() -> Floats:
        points = np.einsum("tk,skx->stx", weights, curves)
        ways = points[pairs[:, 0], :, None] - points[pairs[:, 1], None]
        found: Floats = np.sqrt((ways**2).sum(axis=3).min(axis=(1, 2)))
        return found

    benchmark.pedantic(sample, rounds=5, warmup_rounds=1)


@pytest.mark.parametrize("segments", [3_000, 30_000, 300_000])
def test_near_pairs(benchmark: Any, segments: int) -> None:
    """Which segments are near enough to be measured."""
    benchmark.group = "Near pairs of segments"
    chance = np.random.default_rng(0)
    width = 1.4 * np.sqrt(segments)
    middles = chance.uniform(0, [width, width, 3], (segments // 5, 3))
    curves = np.repeat(middles, 5, axis=0)[:, None] + chance.uniform(-1, 1, (segments, 4, 3))
    arguments = curves, np.repeat(np.arange(segments // 5), 5), np.full(segments, 0.12), CLEARANCE
    found = benchmark.pedantic(near_pairs, arguments, rounds=3, warmup_rounds=1)
    benchmark.extra_info["of"] = f"{segments:,}"
    benchmark.extra_info["pairs"] = f"{len(found):,}"
