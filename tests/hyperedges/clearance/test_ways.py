from __future__ import annotations

import itertools

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.clearance.pieces import cut
from app.hyperedges.clearance.ways import walk, ways_of
from app.hyperedges.curves import join_starts, lay_out, segment_starts
from app.hyperedges.routing import Routing
from tests.hyperedges.clearance.curves import points_at
from tests.hyperedges.scenes import upwards


def trees(radius: float) -> Routing:
    """The paper's curves of three hyperedges."""
    points = np.random.default_rng(0).uniform(0, 9, (13, 3))
    starts = np.array([0, 6, 8, 13])
    laid = lay_out(points, upwards(13), starts, np.full(3, 9.0))
    return Routing(
        control_points=laid.control_points,
        segment_starts=segment_starts(starts),
        segment_ends=laid.ends,
        join_positions=laid.joins,
        join_tangents=laid.tangents,
        join_starts=join_starts(starts),
        join_planes=np.full(3, 9.0),
        radii=np.full(3, radius),
    )


def shortest(pieces: list[Floats]) -> Floats:
    """Ways between pieces that have an end in common, step by step (Floyd and Warshall)."""
    count = len(pieces)
    ways = np.full((count, count), np.inf)
    ends = np.array([[piece[0], piece[3]] for piece in pieces])
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    for a, b in itertools.permutations(range(count), 2):
        if np.abs(ends[a][:, None] - ends[b][None]).max(axis=2).min() < 1e-9:
            ways[a, b] = 0.0
    for k in range(count):
        ways = np.minimum(ways, ways[:, k, None] + lengths[k] + ways[None, k])
    return ways


@pytest.mark.parametrize("radius", [0.1, 1.0, 100.0])
def test_a_way_is_as_long_as_the_pieces_on_it(radius: float) -> None:
    routing = trees(radius)
    pieces = cut(routing.control_points, np.full(len(routing.control_points), radius))
    ways = ways_of(routing, pieces)
    for k in range(3):
        first = int(pieces.starts[routing.segment_starts[k]])
        last = int(pieces.starts[routing.segment_starts[k + 1]])
        expected = shortest(list(pieces.curves[first:last]))
        for a, b in itertools.combinations(range(first, last), 2):
            way = walk(a, b, ways, np.inf)
            assert way.length == pytest.approx(expected[a - first, b - first])
            if way.steps:
                step = walk(way.after, b, ways, np.inf)
                assert step.length == pytest.approx(way.length - ways.lengths[way.after])
                step = walk(a, way.before, ways, np.inf)
                assert step.length == pytest.approx(way.length - ways.lengths[way.before])


def test_ways_between_the_segments_of_a_join_are_forked() -> None:
    routing = trees(100.0)
    pieces = cut(routing.control_points, np.full(len(routing.control_points), 100.0))
    ways = ways_of(routing, pieces)
    ends = routing.segment_ends[:9]
    for a, b in itertools.combinations(range(9), 2):
        way = walk(a, b, ways, np.inf)
        assert way.forked
        assert (way.steps == 0) == bool(set(ends[a]) & set(ends[b]))


def test_pieces_make_up_their_segments() -> None:
    routing = trees(0.1)
    pieces = cut(routing.control_points, np.full(len(routing.control_points), 0.1))
    assert (np.diff(pieces.starts) == 4).all()
    t = np.linspace(0, 1, 9)
    for segment, curve in enumerate(routing.control_points):
        for k in range(4):
            np.testing.assert_allclose(
                points_at(pieces.curves[4 * segment + k], t),
                points_at(curve, (k + t) / 4),
                atol=1e-12,
            )
