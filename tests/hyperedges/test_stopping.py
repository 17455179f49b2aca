"""Routings that are stopped at one of their reports of progress, without any clock."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest

from app.hyperedges.clearance.certificate import certify
from app.hyperedges.route import route
from app.hyperedges.routing import Routing
from app.hyperedges.stopping import Allowance, StoppedError
from app.placement.placement import Placement
from benchmarks.random_programs import CLEARANCE
from tests.hyperedges.scenes import placement as placement_of

Way = Literal["planes", "elastic", "auto"]
WAYS: tuple[Way, ...] = ("planes", "elastic", "auto")


def crowded() -> Placement:
    """Attachments so near each other that nothing can be clear, and all is tried."""
    chance = np.random.default_rng(1)
    return placement_of(chance.uniform(0.0, 1.0, (15, 3)), list(range(0, 16, 3)))


def stopped(
    placement: Placement, way: Way, reports: float, allowance: Allowance | None = None
) -> tuple[Routing, list[float]]:
    """The routing where so many reports of progress are let pass, and all that there were."""
    shares: list[float] = []

    def progress(share: float) -> None:
        shares.append(share)
        if len(shares) > reports:
            raise StoppedError

    found = route(
        placement, routing=way, clearance=CLEARANCE, progress=progress, allowance=allowance
    )
    return found, shares


def faults(routing: Routing, placement: Placement) -> int:
    return len(certify(routing, placement, CLEARANCE).conflicts)


@pytest.mark.parametrize("way", WAYS)
def test_wherever_it_is_stopped_all_hyperedges_have_curves_that_are_judged(way: Way) -> None:
    placement = crowded()
    whole, shares = stopped(placement, way, np.inf)
    at = sorted({0, 1, 2, 3, *np.linspace(0, len(shares) - 1, 6).astype(int).tolist()})
    for reports in at:
        made, told = stopped(placement, way, reports)
        assert len(told) > reports
        assert len(made.radii) == len(placement.radii)
        assert np.isfinite(made.control_points).all()
        np.testing.assert_array_equal(made.attachment_counts, np.full(5, 3))
        ends = made.segment_ends
        owners = np.repeat(np.arange(5), np.diff(made.segment_starts))
        for side, control in ((0, 0), (1, 3)):
            at_attachments = ends[:, side] < 3
            rows = 3 * owners[at_attachments] + ends[at_attachments, side]
            np.testing.assert_allclose(
                made.control_points[at_attachments, control],
                placement.attachment_positions[rows],
                atol=1e-9,
            )
        assert faults(made, placement) > 0
    again, _ = stopped(placement, way, len(shares))
    assert again.control_points.tobytes() == whole.control_points.tobytes()


@pytest.mark.parametrize("way", WAYS)
def test_more_reports_leave_no_more_faults_than_none(way: Way) -> None:
    placement = crowded()
    least = faults(stopped(placement, way, np.inf)[0], placement)
    assert faults(stopped(placement, way, 0)[0], placement) > least


def test_auto_leaves_half_of_the_time_for_planes() -> None:
    placement = crowded()
    allowance = Allowance(lambda: 0.6)
    made, shares = stopped(placement, "auto", np.inf, allowance)
    assert allowance.ran_out
    assert sum(share < 0.5 for share in shares) == 1
    assert max(shares) == 1.0  # planes went to their end
    planes, _ = stopped(placement, "planes", np.inf)
    assert faults(made, placement) <= faults(planes, placement)


def test_auto_does_not_begin_planes_where_no_time_is_left() -> None:
    placement = crowded()
    reports = 0

    def progress(share: float) -> None:
        nonlocal reports
        reports += 1
        assert share <= 0.5
        if share == 0.5:
            raise StoppedError

    made = route(placement, routing="auto", clearance=CLEARANCE, progress=progress)
    elastic, _ = stopped(placement, "elastic", np.inf)
    assert made.control_points.tobytes() == elastic.control_points.tobytes()


def test_a_certificate_that_is_stopped_has_the_conflicts_so_far() -> None:
    placement = crowded()
    routing, _ = stopped(placement, "elastic", 0)

    def stop() -> None:
        raise StoppedError

    whole, cut = (
        certify(routing, placement, CLEARANCE),
        certify(routing, placement, CLEARANCE, stop),
    )
    assert whole.complete
    assert not cut.complete
    assert not cut.certified
    assert cut.nearest is None
    assert cut.minimum <= whole.minimum
    assert len(cut.conflicts) < len(whole.conflicts)


def test_what_has_no_conflicts_so_far_is_not_certified() -> None:
    placement = placement_of(np.array([[0.0, 0, 0], [4, 0, 0], [0, 9, 0], [4, 9, 0]]), [0, 2, 4])
    routing, _ = stopped(placement, "planes", np.inf)

    def stop() -> None:
        raise StoppedError

    assert certify(routing, placement, CLEARANCE).certified
    cut = certify(routing, placement, CLEARANCE, stop)
    assert len(cut.conflicts) == 0
    assert not cut.certified
    assert not cut.complete
