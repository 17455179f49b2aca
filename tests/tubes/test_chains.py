from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.hyperedges.routing import Routing
from app.tubes.chains import Rings, chain_rings
from app.tubes.tessellation import tessellation_of
from tests.tubes.routings import RADIUS, random_routing


def chained(routing: Routing) -> Rings:
    return chain_rings(routing, tessellation_of(routing, 0.002))


def rings_of(rings: Rings, chain: int) -> tuple[Floats, Floats]:
    own = slice(rings.starts[chain], rings.starts[chain + 1])
    shape = (rings.counts[chain], rings.sides[chain], 3)
    return rings.vertices[own].reshape(shape), rings.radials[own].reshape(shape)


@pytest.mark.parametrize("attachments", [2, 3, 5, 8])
def test_a_hyperedge_has_a_chain_fewer_than_attachments(attachments: int) -> None:
    rings = chained(random_routing(1, 6, attachments))
    assert np.diff(rings.chain_starts).tolist() == [attachments - 1] * 6


def test_every_ring_of_a_segment_is_in_one_chain_and_joins_are_in_two() -> None:
    routing = random_routing(1, 6, 5)
    counts = tessellation_of(routing, 0.002).rings.counts
    # Three segments have a ring at each join; a chain passes through it, another ends there.
    assert chained(routing).counts.sum() == counts.sum() - len(routing.join_positions)


def test_chains_run_on_without_a_twist() -> None:
    rings = chained(random_routing(2, 10, 5))
    for chain in range(len(rings.counts)):
        vertices, radials = rings_of(rings, chain)
        middles = vertices - RADIUS * radials
        np.testing.assert_allclose(middles, middles[:, :1].repeat(rings.sides[0], 1), atol=1e-5)
        turns = np.einsum("rnx,rnx->rn", radials[1:], radials[:-1])
        tangents = np.cross(radials[:, 0], radials[:, rings.sides[0] // 4])
        tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
        bends = np.einsum("rx,rx->r", tangents[1:], tangents[:-1])
        side = np.cos(np.pi / rings.sides[0])
        assert (turns.min(axis=1) > bends * side - 0.05).all()
        steps = np.diff(middles[:, 0], axis=0)
        assert (np.einsum("rx,rx->r", steps, tangents[:-1]) > 0).mean() > 0.99


def test_a_join_without_a_way_through_ends_all_its_segments() -> None:
    """All three leave it on one side, which no curves of ours do, but a routing may."""
    ends = np.array([[2.0, 1, 0], [2.0, -1, 0], [3.0, 0, 1]])
    routing = Routing(
        control_points=np.array(
            [[[0.0, 0, 0], [1.0, 0, 0], end - [0.5, 0, 0], end] for end in ends]
        ),
        segment_starts=np.array([0, 3]),
        segment_ends=np.array([[3, 0], [3, 1], [3, 2]]),
        join_positions=np.zeros((1, 3)),
        join_tangents=np.array([[1.0, 0, 0]]),
        join_starts=np.array([0, 1]),
        join_planes=np.zeros(1),
        radii=np.array([RADIUS]),
    )
    assert chained(routing).chain_starts.tolist() == [0, 3]
