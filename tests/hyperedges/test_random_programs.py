"""Random programs in which there is room: every one must come out clear, and its curves good."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pytest
from scipy.spatial import cKDTree

from app.arrays import Floats, Indices
from app.hyperedges.clearance.certificate import Certificate, certify
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.placement.placement import Placement
from benchmarks.random_programs import CLEARANCE, Reach, random_program
from tests.hyperedges import sampling

MANY: list[tuple[int, int, Reach]] = [
    *((10, seed, "spread") for seed in range(20)),
    *((30, seed, "spread") for seed in range(8)),
    *((100, seed, "spread") for seed in range(2)),
    (100, 0, "local"),
]
KINDS: list[tuple[int, Reach]] = [(10, "spread"), (100, "spread"), (300, "spread"), (300, "local")]


@dataclass(frozen=True)
class Routed:
    placement: Placement
    routing: Routing
    certificate: Certificate


@lru_cache(maxsize=len(MANY))
def routed(hyperedges: int, seed: int, reach: Reach) -> Routed:
    placement = random_program(hyperedges, seed, reach).placement()
    routing = route(placement, curves="steiner", clearance=CLEARANCE)
    return Routed(placement, routing, certify(routing, placement, CLEARANCE))


@pytest.fixture(params=MANY, ids=lambda param: "{}-{}-{}".format(*param))
def program(request: pytest.FixtureRequest) -> Routed:
    return routed(*request.param)


def owners(placement: Placement) -> Indices:
    arities = np.diff(placement.attachment_starts)
    return np.repeat(np.arange(len(arities)), arities)


def at_attachments(routing: Routing, placement: Placement) -> tuple[Indices, Indices, Indices]:
    """Segments, which of their ends (0 or 1), and the attachment at it."""
    counts = routing.attachment_counts[sampling.owners(routing)]
    segments, sides = np.nonzero(routing.segment_ends < counts[:, None])
    firsts = placement.attachment_starts[sampling.owners(routing)[segments]]
    return segments, sides, firsts + routing.segment_ends[segments, sides]


def leaving(routing: Routing, segments: Indices, sides: Indices) -> Floats:
    """Unit vectors (m, 3) in which segments leave their end 0 or 1."""
    p = routing.control_points[segments]
    way = np.where(sides[:, None] == 0, p[:, 1] - p[:, 0], p[:, 2] - p[:, 3])
    return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))


def test_every_program_is_certified_clear(program: Routed) -> None:
    conflicts = program.certificate.conflicts
    assert list(zip(conflicts.first, conflicts.second, conflicts.lower, strict=True)) == []
    assert program.certificate.certified
    assert program.certificate.minimum >= CLEARANCE


def test_dense_samples_find_no_tube_too_near(program: Routed) -> None:
    seen = sampling.sample(program.routing)
    assert sampling.tubes_too_near(seen, program.placement.radii, CLEARANCE) == set()
    assert sampling.items_too_near(seen, program.placement, CLEARANCE) == set()


def test_no_curve_pinches_its_tube(program: Routed) -> None:
    assert sampling.pinched(program.routing).tolist() == []


def test_segments_of_a_join_share_its_place_and_tangent(program: Routed) -> None:
    routing = program.routing
    counts = routing.attachment_counts[sampling.owners(routing)]
    segments, sides = np.nonzero(routing.segment_ends >= counts[:, None])
    firsts = routing.join_starts[sampling.owners(routing)[segments]]
    joins = firsts + routing.segment_ends[segments, sides] - counts[segments]
    at = routing.control_points[segments, 3 * sides]
    np.testing.assert_array_equal(at, routing.join_positions[joins])
    along = leaving(routing, segments, sides)
    tangents = routing.join_tangents[joins]
    sines = np.linalg.norm(np.cross(along, tangents), axis=1)
    assert sines.max(initial=0.0) <= 1e-9
    np.testing.assert_allclose(np.linalg.norm(tangents, axis=1), 1.0, atol=1e-12)


def test_every_join_is_where_two_or_three_segments_meet(program: Routed) -> None:
    routing = program.routing
    for k, count in enumerate(routing.attachment_counts):
        ends = routing.segment_ends[routing.segment_starts[k] : routing.segment_starts[k + 1]]
        meeting = np.bincount(ends.ravel())
        assert (meeting[:count] == 1).all()
        assert np.isin(meeting[count:], (2, 3)).all()
        assert (meeting == 3).sum() == count - 2


def test_curves_start_and_end_at_their_attachments_along_their_directions(program: Routed) -> None:
    routing, placement = program.routing, program.placement
    segments, sides, attachments = at_attachments(routing, placement)
    assert sorted(attachments.tolist()) == list(range(len(placement.attachment_items)))
    np.testing.assert_array_equal(
        routing.control_points[segments, 3 * sides], placement.attachment_positions[attachments]
    )
    np.testing.assert_allclose(
        leaving(routing, segments, sides), placement.attachment_directions[attachments], atol=1e-9
    )


@pytest.mark.parametrize(("hyperedges", "seed"), [(10, 0), (10, 1), (30, 0)])
def test_at_the_papers_heights_samples_and_certificate_find_the_same_tubes_cut(
    hyperedges: int, seed: int, record_property: Callable[[str, object], None]
) -> None:
    placement = random_program(hyperedges, seed).placement()
    heights = np.arange(1.0, hyperedges + 1)
    routing = route(placement, curves="prose", fidelity="paper", join_heights=heights)
    found = certify(routing, placement, 0.0).conflicts
    tubes = ~found.with_items
    pairs = zip(found.first[tubes].tolist(), found.second[tubes].tolist(), strict=True)
    lower = dict(zip(pairs, found.lower[tubes].tolist(), strict=True))
    seen = sampling.tubes_too_near(sampling.sample(routing), placement.radii, 0.0)
    assert seen <= set(lower)
    # What samples may overlook does not go deep.
    assert all(lower[pair] > -0.01 for pair in set(lower) - seen)
    cut = {k for pair in lower for k in pair}
    record_property("share of hyperedges that cut another", len(cut) / hyperedges)


def test_a_program_is_the_same_wherever_it_is_made() -> None:
    one, same, other = (random_program(30, seed) for seed in (3, 3, 4))
    assert one.document() == same.document()
    assert one.document() != other.document()


@pytest.mark.parametrize(("hyperedges", "reach"), KINDS)
def test_a_document_is_placed_as_the_program_says(hyperedges: int, reach: Reach) -> None:
    program = random_program(hyperedges, 0, reach)
    placement = program.placement()
    np.testing.assert_array_equal(placement.centers, program.centers)
    np.testing.assert_array_equal(placement.sizes, program.sizes)
    np.testing.assert_allclose(placement.attachment_positions, program.positions, atol=1e-12)
    np.testing.assert_array_equal(placement.attachment_items, program.items)
    np.testing.assert_array_equal(placement.radii, program.radii)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("hyperedges", "reach"), KINDS)
def test_attachments_of_different_hyperedges_leave_room_between_them(
    hyperedges: int, reach: Reach, seed: int
) -> None:
    placement = random_program(hyperedges, seed, reach).placement()
    of, at = owners(placement), placement.attachment_positions
    one, other = cKDTree(at).query_pairs(0.9, output_type="ndarray").T
    one, other = one[of[one] != of[other]], other[of[one] != of[other]]
    apart = np.linalg.norm(at[one] - at[other], axis=1)
    needed = 2 * (placement.radii[of[one]] + placement.radii[of[other]] + CLEARANCE)
    assert (apart >= needed - 1e-12).all()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(("hyperedges", "reach"), KINDS)
def test_items_do_not_overlap_and_keep_away_from_attachments_of_others(
    hyperedges: int, reach: Reach, seed: int
) -> None:
    placement = random_program(hyperedges, seed, reach).placement()
    lows, highs = (placement.centers + sign * placement.sizes / 2 for sign in (-1, 1))
    for item in range(len(lows)):
        apart = np.maximum(lows[item, :2] - highs[:, :2], lows[:, :2] - highs[item, :2]).max(axis=1)
        assert (np.delete(apart, item) > 0).all()
    at, on = placement.attachment_positions, placement.attachment_items
    radii = placement.radii[owners(placement)]
    for item in range(len(lows)):
        outside = np.maximum(lows[item, :2] - at[:, :2], at[:, :2] - highs[item, :2])
        away = np.linalg.norm(np.maximum(outside, 0), axis=1)
        assert (away[on != item] >= 2 * (radii[on != item] + 0.2 + CLEARANCE) - 1e-12).all()
        inset = -outside[on == item].max(initial=-np.inf)
        assert inset >= radii[on == item].max(initial=0.0)


def test_a_local_hyperedge_spans_a_small_part_of_its_program() -> None:
    def span(reach: Reach) -> float:
        program = random_program(300, 0, reach)
        starts = program.starts[:-1]
        lows = np.minimum.reduceat(program.positions, starts)
        highs = np.maximum.reduceat(program.positions, starts)
        return float(np.median(np.linalg.norm(highs - lows, axis=1)))

    assert span("local") < span("spread") / 4
